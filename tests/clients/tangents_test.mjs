// Tangents that a normal map needs turn with the surface, in all targets of all primitives that have a map, and in no
// others. Read by code that shares nothing with what wrote them.
// Usage: node tangents_test.mjs --morphbake PROGRAM
import { readFileSync, writeFileSync } from 'node:fs';
import { deflateSync } from 'node:zlib';
import path from 'node:path';
import { png } from '../cli/bad_gltf/pictures.mjs';
import { parseGlb, readAccessor } from './reference/glb.mjs';
import { makeShape } from './shapes/make_shapes.mjs';
import { packChunks } from './shapes/write_glb.mjs';
import { bake, readArguments, startChecks, withFolder } from './support.mjs';

const { morphbake } = readArguments('morphbake');
const checks = startChecks();

/** The drum with tangents; only its first primitive has a normal map. @return tangents of the first primitive */
function addTangents(folder) {
  makeShape('drum.glb', folder);
  const file = path.join(folder, 'drum.glb');
  const glb = parseGlb(readFileSync(file));
  const { json } = glb;
  const parts = [Buffer.from(glb.bin)];
  let length = glb.bin.length;
  const append = (bytes) => {
    json.bufferViews.push({ buffer: 0, byteOffset: length, byteLength: bytes.length });
    const padded = Buffer.concat([bytes, Buffer.alloc((4 - bytes.length % 4) % 4)]);
    parts.push(padded);
    length += padded.length;
    return json.bufferViews.length - 1;
  };
  const tangents = json.meshes[0].primitives.map(({ attributes }) => {
    const normals = readAccessor(glb, attributes.NORMAL);
    const rows = new Float32Array(normals.length / 3 * 4);
    for (let i = 0; i < normals.length / 3; i++) {
      const [x, y, z] = normals.subarray(3 * i, 3 * i + 3);
      const [a, b, c] = Math.abs(y) < 0.9 ? [z, 0, -x] : [y, -x, 0];  // at right angles to the normal
      const size = Math.hypot(a, b, c);
      rows.set([a / size, b / size, c / size, i % 2 ? 1 : -1], 4 * i);
    }
    attributes.TANGENT = json.accessors.push({ bufferView: append(Buffer.from(rows.buffer)), componentType: 5126, count: rows.length / 4, type: 'VEC4' }) - 1;
    return rows;
  });
  for (const node of json.nodes) { delete node.rotation; delete node.translation; }
  json.images = [{ mimeType: 'image/png', bufferView: append(png(1, 1, { pixels: deflateSync(Buffer.from([0, 128, 128, 255])) })) }];
  json.textures = [{ source: 0 }];
  json.materials = [{ name: 'mapped', normalTexture: { index: 0 } }, { name: 'plain' }];
  json.meshes[0].primitives.forEach((primitive, p) => { primitive.material = p; });
  json.buffers[0].byteLength = length;
  writeFileSync(file, packChunks(json, Buffer.concat(parts)));
  return tangents[0];
}

await withFolder((folder) => {
  const given = addTangents(folder);
  const file = path.join(folder, 'recipe.json');
  writeFileSync(file, JSON.stringify({ version: 1, name: 'turned', representation: 'laplacian', hold: 'none',
    sources: { drum: 'drum.glb', turned: { transform: { of: 'drum', rotate: { axis: [0, 0, 1], degrees: 90 } } } },
    timeline: { fps: 8, tracks: [{ name: 'turn', to: 'turned', begin: 0, end: 1 }] },
    outputs: [{ file: 'frames.glb', targets: 'frames' }, { file: 'still.glb', still: { at: 1 } }] }));
  bake(morphbake, file, path.join(folder, 'out'));
  const glb = parseGlb(readFileSync(path.join(folder, 'out', 'frames.glb')));
  const [mapped, plain] = glb.json.meshes[0].primitives;
  checks.check(!plain.targets.some((target) => 'TANGENT' in target), 'a primitive without a normal map has tangents that morph');
  // The drum's node scales it by (0.5, 1.5, 1): what turns in the scene is scaled back for the mesh.
  const scale = glb.json.nodes.find(({ mesh }) => mesh === 0).scale ?? [1, 1, 1];
  const still = parseGlb(readFileSync(path.join(folder, 'out', 'still.glb')));
  const ends = {
    frames: { rows: readAccessor(glb, mapped.attributes.TANGENT), moves: readAccessor(glb, mapped.targets.at(-1).TANGENT) },
    still: { rows: readAccessor(still, still.json.meshes[0].primitives[0].attributes.TANGENT) } };
  for (const [name, { rows, moves }] of Object.entries(ends)) {
    let worst = 1;
    for (let i = 0; i < rows.length / 4; i++) {
      const [x, y, z] = [0, 1, 2].map((axis) => given[4 * i + axis] * scale[axis]);
      const turned = [-y, x, z].map((number, axis) => number / scale[axis]);
      const found = [0, 1, 2].map((axis) => rows[4 * i + axis] + (moves ? moves[3 * i + axis] : 0));
      const cosine = turned.reduce((sum, number, axis) => sum + number * found[axis], 0) / Math.hypot(...turned) / Math.hypot(...found);
      worst = Math.min(worst, cosine);
      checks.check(rows[4 * i + 3] === given[4 * i + 3], `${name}: handedness of ${i}`);
    }
    console.log(`${name}: tangents at most ${(Math.acos(worst) * 180 / Math.PI).toFixed(3)} degrees off`);
    // Normals turn by the smallest rotation of the surface's, which is a degree off where the file's are not the surface's.
    checks.check(worst > Math.cos(1.5 * Math.PI / 180), `${name}: tangents are ${Math.acos(worst) * 180 / Math.PI} degrees off`);
  }
});
checks.finish('tangents turn');
