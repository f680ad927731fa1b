// What engines read at most counts all targets of the mesh that is written: its own and the new ones.
//
//   node many_targets.mjs MORPHBAKE SCRATCH
import { spawnSync } from 'node:child_process';
import { mkdirSync, rmSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { octahedron } from './bad_gltf/good.mjs';

const [program, scratch] = process.argv.slice(2);
const WARNING = '256 morph targets; three.js and Babylon.js read at most 255';
let failed = 0;

/** Bakes one new target behind `own` ones; whether it was warned of. */
function isWarnedOf(own) {
  const folder = join(scratch, String(own));
  mkdirSync(folder, { recursive: true });
  const source = octahedron();
  source.meshes[0].primitives[0].targets = new Array(own).fill({ POSITION: 0, NORMAL: 1 });
  writeFileSync(join(folder, 'a.gltf'), JSON.stringify(source));
  writeFileSync(join(folder, 'b.gltf'), JSON.stringify({ ...octahedron(), nodes: [{ mesh: 0, scale: [2, 1, 1] }] }));
  writeFileSync(join(folder, 'recipe.json'), JSON.stringify({ version: 1, name: 'many',
    sources: { a: 'a.gltf', b: 'b.gltf' }, timeline: { tracks: [{ name: 'all', to: 'b', begin: 0, end: 1 }] },
    outputs: [{ file: 'many.glb', targets: 'tracks' }] }));
  const { status, stderr } = spawnSync(program, ['bake', join(folder, 'recipe.json'), '--preview', 'none'], { encoding: 'utf8' });
  if (status === 0 && stderr.includes('[export.many-targets]') === stderr.includes(WARNING)) return stderr.includes(WARNING);
  ++failed;
  console.log(`FAILED: ${own} own targets: exit code ${status}\n${stderr}`);
  return undefined;
}

rmSync(scratch, { recursive: true, force: true });
for (const [own, expected] of [[254, false], [255, true]]) {
  if (isWarnedOf(own) === expected) continue;
  ++failed;
  console.log(`FAILED: ${own} own targets and a new one: ${expected ? 'no' : 'a'} warning`);
}
console.log(failed ? `${failed} failures` : 'passed');
process.exit(failed ? 1 : 0);
