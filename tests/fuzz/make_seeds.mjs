// Writes the files from which fuzzing starts: small ones, each another feature.
//
//   node make_seeds.mjs FOLDER    makes FOLDER/gltf, FOLDER/recipe, ...
import { existsSync, mkdirSync, readdirSync, readFileSync, rmSync, statSync, writeFileSync } from 'node:fs';
import { basename, dirname, extname, join, relative } from 'node:path';
import { fileURLToPath } from 'node:url';
import * as accessors from '../cli/bad_gltf/accessors.mjs';
import * as container from '../cli/bad_gltf/container.mjs';
import { binaryOctahedron, container as glb, octahedron } from '../cli/bad_gltf/good.mjs';
import * as packed from '../cli/bad_gltf/packed.mjs';
import * as pictures from '../cli/bad_gltf/pictures.mjs';
import * as scene from '../cli/bad_gltf/scene.mjs';

const LARGEST = 65536;  // bytes: what libFuzzer is told to make at most
const folder = process.argv[2];
const root = join(dirname(fileURLToPath(import.meta.url)), '..', '..');

function filesBelow(path, extensions) {
  if (!existsSync(path)) return [];
  return readdirSync(path, { recursive: true, withFileTypes: true })
    .filter((entry) => entry.isFile() && extensions.includes(extname(entry.name)))
    .map((entry) => join(entry.parentPath ?? entry.path, entry.name))
    .filter((file) => !relative(root, file).includes('node_modules') && statSync(file).size <= LARGEST);
}

function write(kind, name, bytes) {
  if (bytes.length <= LARGEST) writeFileSync(join(folder, kind, name.replaceAll(/[^A-Za-z0-9.]/g, '_')), bytes);
}

/** The file that `change` makes of the octahedron. */
function made(change) {
  const gltf = octahedron();
  const result = change(gltf);
  return typeof result === 'string' || Buffer.isBuffer(result) ? result : JSON.stringify(gltf);
}

rmSync(folder, { recursive: true, force: true });
for (const kind of ['cache', 'gltf', 'landmarks', 'manifest', 'recipe', 'report']) mkdirSync(join(folder, kind), { recursive: true });

write('gltf', 'octahedron.gltf', JSON.stringify(octahedron()));
write('gltf', 'octahedron.glb', made((gltf) => { const { json, bin } = binaryOctahedron(gltf); return glb([json, bin]); }));
const chosen = Object.fromEntries(Object.entries(scene.chosen).map(([name, [, ...definition]]) => [name, definition]));
for (const { baked = {}, previewed = {}, legal = {} } of [accessors, container, packed, pictures, scene, { legal: chosen }]) {
  for (const [name, [change]] of Object.entries({ ...baked, ...previewed, ...legal })) {
    if (!/800 MB|268 MB|64 MB|million/.test(name)) write('gltf', `${name}.gltf`, made(change));
  }
}
for (const place of ['examples', 'tests/clients/forms', 'tests/clients/shapes']) {
  for (const file of filesBelow(join(root, place), ['.glb', '.gltf'])) write('gltf', basename(file), readFileSync(file));
}
for (const place of ['examples', 'tests/cli', 'tests/clients']) {
  for (const file of filesBelow(join(root, place), ['.json'])) {
    if (readFileSync(file, 'utf8').includes('"sources"')) write('recipe', relative(root, file), readFileSync(file));
  }
}
for (const file of filesBelow(join(root, 'examples/shapes'), ['.json'])) write('landmarks', basename(file), readFileSync(file));
write('landmarks', 'ways.json', JSON.stringify({
  version: 1, landmarks: { a: { vertex: 3 }, b: { face: 1, barycentric: [0.5, 0.25, 0.25] }, c: { position: [0, -1e-3, 2] } },
}));
// Bodies of entries: facts, and blobs of the sizes that the stages expect.
const solve = { representation: 'laplacian', representation_reason: '', solver: 'direct', reason: '', unknowns: 2, held: 0, factor_bytes: 0, solves: [] };
const entries = {
  shapes: [{ names: ['a'], report: solve }, [48, 48]],
  regions: [{ softness: [0.5, 0] }, [16, 16]],
  files: [{ endings: ['.gif'] }, [1]],
  output: [{ node: 0, report: { kind: 'tracks', targets: ['a'], weight_keys: 2, max_error: 0, worst_time: 0, worst_vertex: 0, normals: { maximum: 0, percentile_99: 0, time: 0, vertex: 0 } } }, [4]],
  report: [{ vertices: 2, triangles: 1, components: 1, frames: 2, solve, connectivity: { mode: 'remesh', vertices: 2, triangles: 1, repairs: [{ source: 'a', repairs: { degenerate: 0, duplicate: 0, turned: 0 } }], steps: [{ name: 'sphere', seconds: 1 }], texture: null, quality: null } }, []],
};
for (const [name, [facts, blobs]] of Object.entries(entries)) {
  write('cache', name, Buffer.concat([Buffer.from(`${JSON.stringify({ facts, blobs })}\n`), ...blobs.map((size) => Buffer.alloc(size))]));
}
// The first byte says what follows: a list, a table of CSV, a table of objects.
write('manifest', 'list', `0"a.json"\n{"recipe": "a.json", "name": "b/c", "set": {"/timeline/duration": 2, "/a~1b/0": [1]}}\n`);
write('manifest', 'report', '0{"name":"a","state":"failed","recipe":"../a.json","problems":[]}\n');
write('manifest', 'csv', '1name,/timeline/tracks/0/end,/name\r\nlong,4,"a ""b"",\nc"\r\n,late,\r\n');
write('manifest', 'objects', '2{"name": "x", "/name": "y"}\n{"/sources/a": null}\n');
const file = { file: 'a', bytes: 1, mtime_ns: 1700000000000000000, hash: 'h' };
const problem = { severity: 'warning', code: 'a.b', file: 'f', pointer: '/p', line: 1, column: 2, message: 'm', hint: '' };
const bake = { vertices: 1, triangles: 1, frames: 1, targets: 1, bytes: 1, max_error: 1e-3, normal_error: 0.5, stages: [{ name: 's', seconds: 1 }], cached: ['c'] };
const ending = { morphbake: '0', request: 'r', key: 'k', connectivity: 'c', written_ns: 1700000000000000000, inputs: [file, { file: 'b', missing: true }], outputs: [{ ...file, file: 'a/a.sheet.png' }] };
const lines = [
  { name: 'a\n"\\', state: 'done', recipe: '../a.json', set: { '/name': 'x' }, seconds: 1.5, bake, problems: [problem], ...ending },
  { name: 'b', state: 'failed', recipe: 'b.json', seconds: 0, problems: [{ ...problem, severity: 'error' }], log: '\u001b[31m<b>', ...ending },
].map((line) => JSON.stringify(line));
write('report', 'two', `${lines[0]}\n${lines[1]}\n`);
write('report', 'torn', `${lines[0].slice(0, 90)}\n${lines[1]}\n${lines[0].slice(0, 60)}`);
// Names as the fuzz target has them beside the recipe.
write('recipe', 'two_sources.json', JSON.stringify({
  version: 1, name: 'two', sources: { a: 'a.glb', b: 'b.glb' },
  regions: { nose: { landmark: 'nose', inner: 0.1, outer: 0.3 } },
  timeline: { tracks: [{ name: 'all', to: 'b', begin: 0, end: 1 }] },
  outputs: [{ file: 'out.glb' }],
}));
