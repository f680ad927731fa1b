// node make_hero.mjs IN.glb OUT.glb: a file with one node becomes one with "Body" and, beside it, "Hat" with a mesh of its own.
import { readFileSync, writeFileSync } from 'node:fs';

const [from, to] = process.argv.slice(2);
const bytes = readFileSync(from);
const length = bytes.readUInt32LE(12);
const json = JSON.parse(bytes.toString('utf8', 20, 20 + length));
json.nodes[0].name = 'Body';
const { targets, ...plain } = json.meshes[0].primitives[0];
json.meshes.push({ name: 'HatMesh', primitives: [plain] });
json.nodes.push({ name: 'Hat', mesh: json.meshes.length - 1, translation: [0, 1, 0] });
json.scenes[0].nodes.push(json.nodes.length - 1);
const text = Buffer.from(JSON.stringify(json));
const padded = Buffer.concat([text, Buffer.alloc((4 - text.length % 4) % 4, ' ')]);
const rest = bytes.subarray(20 + length);
const header = Buffer.alloc(20);
header.write('glTF');
header.writeUInt32LE(2, 4);
header.writeUInt32LE(20 + padded.length + rest.length, 8);
header.writeUInt32LE(padded.length, 12);
header.write('JSON', 16);
writeFileSync(to, Buffer.concat([header, padded, rest]));
