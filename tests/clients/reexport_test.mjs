// Bodies and faces dressed and exported by Blender (UVs, materials, texture, shape keys, skin, actions) morph and are kept.
// Usage: node reexport_test.mjs --morphbake PROGRAM --meshes FOLDER --output FOLDER SET/A,B...
// The files are left in OUTPUT/baked.
import { spawnSync } from 'node:child_process';
import { existsSync, mkdirSync, rmSync, writeFileSync } from 'node:fs';
import path from 'node:path';
import { fileURLToPath } from 'node:url';
import { countIssues, errorsIn, newIssues } from './issues.mjs';
import { findLost } from './kept.mjs';
import { openPlain } from './reference/plain.mjs';
import { evaluateScene } from './reference/scene.mjs';
import { diagonal } from './reference/vectors.mjs';
import { farthest, shapeOf } from './shape.mjs';
import { bake, readArguments, skip, startChecks } from './support.mjs';

const SCRIPT = path.join(path.dirname(fileURLToPath(import.meta.url)), 'blender', 'export_pairs.py');
const TOLERANCE = 1e-5;  // fraction of the diagonal
const { morphbake, meshes, output, files: pairs } = readArguments('morphbake', 'meshes', 'output');
const checks = startChecks();

/** Has Blender write OUTPUT/sources/SET/a.glb and b.glb of every pair. */
function exportPairs() {
  const files = pairs.flatMap((pair) => {
    const [set, names] = pair.split('/');
    return names.split(',').map((name) => path.join(meshes, set, `${name}.glb`));
  });
  for (const file of files) if (!existsSync(file)) skip(`${file} is not there`);
  const { error, status, stdout, stderr } = spawnSync('blender', ['--background', '--factory-startup', '--python-exit-code', '1',
    '--python', SCRIPT, '--', path.join(output, 'sources'), ...files], { encoding: 'utf8', maxBuffer: 1 << 28 });
  if (error?.code === 'ENOENT') skip('blender is not installed (apt-get install blender python3-numpy)');
  if (status !== 0) throw new Error(`Blender ended with ${status}: ${(stdout + stderr).slice(-2000)}`);
}

function writeRecipe(set, folder) {
  const recipe = { version: 1, name: set, sources: { a: 'a.glb', b: 'b.glb' },
    timeline: { keys: [{ time: 0, state: 'a' }, { time: 1, state: 'b' }] },
    outputs: [{ file: `${set}.glb`, targets: 'tracks' }] };
  const file = path.join(folder, 'recipe.json');
  writeFileSync(file, JSON.stringify(recipe));
  return file;
}

async function testPair(set) {
  const folder = path.join(output, 'sources', set);
  const [source, goal] = ['a.glb', 'b.glb'].map((name) => path.join(folder, name));
  const issues = await countIssues(source);
  checks.check(errorsIn(issues).length === 0, `${set}: Blender's file is not legal: ${errorsIn(issues)}`);
  bake(morphbake, writeRecipe(set, folder), path.join(output, 'baked'));
  const file = path.join(output, 'baked', `${set}.glb`);
  for (const [second, expected] of [[source, 0], [file, 1]]) {
    const { status, stderr } = spawnSync(morphbake, ['diff', source, second], { encoding: 'utf8' });
    checks.check(status === expected, `${set}: diff of Blender's file and ${second} ends with ${status}: ${stderr}`);
  }
  for (const issue of newIssues(issues, await countIssues(file))) checks.check(false, `${set}: ${issue}`);
  const [a, b, baked] = await Promise.all([source, goal, file].map(openPlain));
  const node = a.json.nodes.findIndex(({ mesh }) => mesh !== undefined);
  checks.check(a.json.skins?.length === 1 && a.json.meshes[0].primitives.length === 2 && a.json.animations?.length === 2,
    `${set}: Blender's file has not the skin, materials and actions that this test is for`);
  for (const lost of await findLost(source, file, { node })) checks.check(false, `${set}: ${lost}`);
  const scale = diagonal(shapeOf(evaluateScene(a), node));
  const animation = baked.json.animations.length - 1;
  const off = [a, b].map((plain, time) =>
    farthest(shapeOf(evaluateScene(baked, { animation, time }), node), shapeOf(evaluateScene(plain), node)) / scale);
  console.log(`${set}: off by ${off[0].toExponential(1)} at the start, ${off[1].toExponential(1)} at the end`);
  checks.check(Math.max(...off) <= TOLERANCE, `${set}: the ends are ${off} of the diagonal off`);
}

rmSync(output, { recursive: true, force: true });
mkdirSync(output, { recursive: true });
exportPairs();
for (const pair of pairs)
  try {
    await testPair(pair.split('/')[0]);
  } catch (error) {
    checks.check(false, `${pair}: ${error.message}`);
  }
checks.finish(`${pairs.length} pairs that Blender exported morph and are kept`);
