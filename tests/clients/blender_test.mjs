// Blender's importer opens every file: meshes, vertices, shape keys, how far each moves, actions.
// Usage: node blender_test.mjs FILE_OR_FOLDER...
import { spawnSync } from 'node:child_process';
import { readFileSync } from 'node:fs';
import path from 'node:path';
import { fileURLToPath } from 'node:url';
import { readAccessor } from './reference/glb.mjs';
import { openPlain } from './reference/plain.mjs';
import { cornersOf } from './reference/scene.mjs';
import { at, length } from './reference/vectors.mjs';
import { findGlbs, readArguments, skip, startChecks, withFolder } from './support.mjs';

const SCRIPT = path.join(path.dirname(fileURLToPath(import.meta.url)), 'blender', 'open_files.py');
const TOLERANCE = 1e-5;  // of the longest move
const { files: names } = readArguments();
const checks = startChecks();

/** A mesh as Blender must have it: vertices that triangles use, and the longest move of each target. */
function expectMesh(plain, { mesh, skin }) {
  const surfaces = plain.json.meshes[mesh].primitives.filter(({ mode = 4 }) => mode >= 4);
  const used = surfaces.map((primitive) => new Set(cornersOf(plain, primitive)));
  const count = surfaces[0]?.targets?.length ?? 0;
  const moves = Array.from({ length: count }, (_, k) => Math.max(...surfaces.map(({ targets }, p) => {
    const deltas = readAccessor(plain, targets[k].POSITION);
    return Math.max(...[...used[p]].map((i) => length(at(deltas, i))));
  })));
  return { vertices: used.reduce((sum, set) => sum + set.size, 0), moves, skinned: skin !== undefined };
}

const summary = ({ vertices, moves }) => `${vertices} vertices, ${moves.length} shape keys`;

function compare(file, plain, found) {
  const check = (holds, message) => checks.check(holds, `${file}: ${message}`);
  if (!check(!found.error, `Blender says: ${found.error}`)) return;
  const expected = plain.json.nodes.filter(({ mesh }) => mesh !== undefined).map((node) => expectMesh(plain, node));
  const meshes = found.meshes.map(({ moves, ...mesh }) => ({ ...mesh, moves: Object.values(moves) }));
  if (!check(meshes.map(summary).sort().join('; ') === expected.map(summary).sort().join('; '),
    `Blender has ${meshes.map(summary).join('; ')}, expected ${expected.map(summary).join('; ')}`)) return;
  for (const mesh of expected.filter(({ skinned }) => !skinned)) {
    const longest = Math.max(...mesh.moves);
    const isAlike = ({ vertices, moves }) => vertices === mesh.vertices && moves.length === mesh.moves.length &&
      moves.every((move, k) => Math.abs(move - mesh.moves[k]) <= TOLERANCE * longest);
    check(meshes.some(isAlike),
      `no mesh of Blender's has ${mesh.vertices} vertices and moves by ${mesh.moves}; ${JSON.stringify(meshes)}`);
  }
  // Blender does not know KHR_animation_pointer: a clip of such channels alone is none to it.
  const clips = (plain.json.animations ?? []).filter(({ channels }) => channels.some(({ target }) => target.path !== 'pointer')).length;
  check(found.actions >= clips, `Blender has ${found.actions} actions, expected ${clips} at least`);
}

/** What the script found, by file; a crash of Blender names no file. */
async function openAll(files) {
  return withFolder((folder) => {
    const result = path.join(folder, 'found.json');
    const { error, stdout, stderr } = spawnSync('blender',
      ['--background', '--factory-startup', '--python', SCRIPT, '--', result, ...files], { encoding: 'utf8', maxBuffer: 1 << 28 });
    if (error?.code === 'ENOENT') skip('blender is not installed (apt-get install blender python3-numpy)');
    try {
      return JSON.parse(readFileSync(result, 'utf8'));
    } catch {
      throw new Error(`Blender wrote no result: ${(stdout + stderr).slice(-2000)}`);
    }
  });
}

const files = findGlbs(names);
checks.check(files.length > 0, 'there is no file to open');
const found = await openAll(files);
for (const file of files) compare(file, await openPlain(file), found[file]);
checks.finish(`${files.length} files open in Blender`);
