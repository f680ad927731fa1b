// A source with a turned, a duplicate and a degenerate triangle: it bakes, moves as one without them, and is told of.
//
//   node mended.mjs MORPHBAKE SCRATCH
import { spawnSync } from 'node:child_process';
import { mkdirSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { findMeshNode, parseGlb, readAccessor } from '../clients/reference/glb.mjs';
import { sphere, write_gltf } from './meshes.mjs';

const [program, scratch] = process.argv.slice(2);
const SLOWNESS = 'LSAN_OPTIONS' in process.env ? 5 : 1;  // of the sanitizers
let failures = 0;
const wrong = (text) => { console.log(`WRONG: ${text}`); ++failures; };

function run(...command) {
  const done = spawnSync(program, command, { encoding: 'utf8', timeout: SLOWNESS * 120000 });
  if (done.status !== 0) wrong(`exit code ${done.status}: morphbake ${command.join(' ')}\n${done.stderr}`);
  return done;
}

const TURNED = 50, TWIN = 100;

/** The mesh with all three, the duplicate with vertices of its own. */
function damaged({ points, faces }) {
  const twins = faces[TWIN].map((v) => points[v]), end = points.length;
  const [a, b, c] = faces[TURNED];
  return { points: [...points, ...twins], faces: [...faces.map((face, f) => (f === TURNED ? [a, c, b] : face)), [end + 1, end, end + 2], [7, 7, 8]] };
}

/** Bakes two sources; base and displacements of each vertex, what was said, and the report. */
function baked(name, meshes) {
  const folder = join(scratch, name);
  mkdirSync(folder, { recursive: true });
  for (const [source, mesh] of Object.entries(meshes)) write_gltf(folder, source, mesh);
  writeFileSync(join(folder, 'recipe.json'), JSON.stringify({
    version: 1, name, sources: { a: { file: 'a.gltf' }, b: { file: 'b.gltf' } },
    regions: { cap: { ball: { on: 'a', at: { position: [0, 0, 1] }, inner: 0.1, outer: 0.4 } } },
    timeline: { tracks: [{ name: 't', to: 'b', region: 'cap', begin: 0, end: 1 }] },
  }));
  const { stderr } = run('bake', join(folder, 'recipe.json'), '--report', join(folder, 'report.json'));
  const glb = parseGlb(readFileSync(join(folder, `${name}.glb`)));
  const primitive = glb.json.meshes[findMeshNode(glb).node.mesh].primitives[0];
  return {
    folder, stderr, report: JSON.parse(readFileSync(join(folder, 'report.json'), 'utf8')),
    base: readAccessor(glb, primitive.attributes.POSITION), moves: readAccessor(glb, primitive.targets[0].POSITION),
    indices: readAccessor(glb, primitive.indices),
  };
}

rmSync(scratch, { recursive: true, force: true });
const ball = sphere(24, 16), egg = sphere(24, 16, ([x, y, z]) => [x * (1 + 0.3 * z), 0.8 * y, 1.4 * z]);
const whole = baked('whole', { a: ball, b: egg });
const mended = baked('mended', { a: damaged(ball), b: damaged(egg) });

for (const { source, ...counts } of mended.report.connectivity.repairs) {
  if (JSON.stringify(counts) !== '{"degenerate":1,"duplicate":1,"turned":1}') wrong(`repairs of ${source}: ${JSON.stringify(counts)}`);
}
if (mended.report.connectivity.repairs.length !== 2) wrong('repairs are not told of each source');
for (const part of ['warning: of "a", "b": 1 degenerate triangle is left out, 1 duplicate triangle is left out, 1 triangle is turned', '[connectivity.repaired]']) {
  if (!mended.stderr.includes(part)) wrong(`stderr lacks ${part}\n${mended.stderr}`);
}
if (!mended.report.problems.some(({ code }) => code === 'connectivity.repaired')) wrong('the report has no such warning');
if (whole.stderr.includes('repaired')) wrong('a warning without a reason');

// The file keeps its triangles, and moves as the one that needed no mending; the duplicate's vertices with their twins.
if (mended.indices.join() !== damaged(ball).faces.flat().join()) wrong('the file\'s triangles have changed');
const twin_of = (v) => (v < ball.points.length ? v : ball.faces[TWIN][v - ball.points.length]);
let furthest = 0, largest = 0;
for (let v = 0; v < mended.moves.length / 3; ++v) {
  for (let k = 0; k < 3; ++k) {
    furthest = Math.max(furthest, Math.abs(mended.moves[3 * v + k] - whole.moves[3 * twin_of(v) + k]));
    largest = Math.max(largest, Math.abs(mended.moves[3 * v + k]));
    if (mended.base[3 * v + k] !== whole.base[3 * twin_of(v) + k]) wrong(`vertex ${v} rests elsewhere`);
  }
}
if (largest < 0.1) wrong(`nothing moves: ${largest}`);
if (furthest > 1e-5) wrong(`the mended file moves differently, by ${furthest}`);

// What `inspect` says of it.
const health = JSON.parse(run('inspect', join(mended.folder, 'a.gltf'), '--json').stdout).health;
if (health.is_refused || health.genus !== 0 || health.boundary_loops !== 0) wrong(`health: ${JSON.stringify(health)}`);
for (const [kind, triangle] of [['turned_triangles', TURNED], ['duplicate_triangles', 720], ['degenerate_triangles', 721]]) {
  if (health[kind].count !== 1 || health[kind].places[0].triangle !== triangle) wrong(`health: ${kind} ${JSON.stringify(health[kind])}`);
}
const words = run('inspect', join(mended.folder, 'a.gltf')).stdout;
for (const part of ['health      closed, 1 component, genus 0', `1 triangle is turned: triangle ${TURNED} at (`, 'Recalculate Outside']) {
  if (!words.includes(part)) wrong(`inspect lacks ${part}\n${words}`);
}
// A surface that a bake refuses is examined too.
const finned = { points: [...ball.points, [3, 3, 3]], faces: [...ball.faces, [ball.faces[0][0], ball.faces[0][1], ball.points.length]] };
write_gltf(scratch, 'finned', finned);
const refused = run('inspect', join(scratch, 'finned.gltf')).stdout;
for (const part of ['health      a bake refuses it; 1 component', '1 edge has more than two triangles: triangle ', 'Non Manifold']) {
  if (!refused.includes(part)) wrong(`inspect lacks ${part}\n${refused}`);
}

console.log(failures ? `${failures} wrong` : 'all right');
process.exit(failures ? 1 : 0);
