// Sources and landmarks that cannot be remeshed, or only just: what `validate` and `remesh` say of them.
//
//   node bad_remesh.mjs MORPHBAKE SCRATCH
//
// Both must end with the same exit code and errors, and leave no output behind when there are any.
import { spawn, spawnSync } from 'node:child_process';
import { existsSync, mkdirSync, readdirSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { sphere, torus, write_gltf } from './meshes.mjs';

const [program, scratch] = process.argv.slice(2);
const SLOWNESS = 'LSAN_OPTIONS' in process.env ? 5 : 1;  // of the sanitizers
let failures = 0;
const wrong = (text) => { console.log(`WRONG: ${text}`); ++failures; };

const axes = { top: [0, 0, 1], front: [1, 0, 0], left: [0, 1, 0], back: [-1, 0, 0] };
const landmarks = (change = (p) => p, names = Object.keys(axes)) =>
  Object.fromEntries(names.map((name) => [name, { position: change(axes[name]) }]));
const egg = ([x, y, z]) => [x * (1 + 0.3 * z), 0.8 * y, 1.4 * z];
const turned = ({ points, faces }) => ({ points, faces: faces.map(([a, b, c]) => [a, c, b]) });
const good = { mesh: sphere(16, 12, egg), landmarks: landmarks(egg) };
const ball = (change = (mesh) => mesh, marks = landmarks()) => ({ mesh: change(sphere(16, 12)), landmarks: marks });

/** Writes a recipe with two sources into a folder of its own; its file. */
function recipe(name, a, b, connectivity = {}) {
  const folder = join(scratch, name);
  mkdirSync(folder, { recursive: true });
  const sources = {};
  for (const [source, { mesh, landmarks: marks }] of Object.entries({ a, b })) {
    write_gltf(folder, source, mesh);
    sources[source] = { file: `${source}.gltf`, landmarks: marks };
  }
  const file = join(folder, 'recipe.json');
  writeFileSync(file, JSON.stringify({
    version: 1, name: 'x', sources,
    connectivity: { mode: 'remesh', max_error: 0.05, max_vertices: 150, target_edge_length: 0.5, ...connectivity },
    timeline: { tracks: [{ name: 't', to: 'b', begin: 0, end: 1 }] },
  }));
  return file;
}

const files_in = (folder) => (existsSync(folder) ? readdirSync(folder) : []);
const errors_in = (text) => text.split('\n').filter((line) => line.includes(': error: '));

/** `expected`: the errors that validate and remesh must both tell, all of them, each by a part of its line. */
function refused(name, code, expected, a, b, connectivity) {
  const file = recipe(name, a, b, connectivity);
  const out = join(scratch, name, 'out');
  for (const command of [['validate', file], ['remesh', file, '-o', out], ['bake', file, '--output-dir', out]]) {
    const run = spawnSync(program, command, { encoding: 'utf8', timeout: SLOWNESS * 60000 });
    if (run.status !== code) wrong(`${name}: ${command[0]}: exit code ${run.status}, not ${code}\n${run.stderr}`);
    const missing = expected.filter((part) => !run.stderr.includes(part));
    if (missing.length) wrong(`${name}: ${command[0]} does not say ${missing.join(' | ')}\n${run.stderr}`);
    const told = errors_in(run.stderr).length, wanted = expected.filter((part) => part.endsWith(']')).length;
    if (told !== wanted) wrong(`${name}: ${command[0]} tells ${told} errors, not ${wanted}\n${run.stderr}`);
    if (files_in(out).length) wrong(`${name}: ${command[0]} left ${files_in(out)}`);
  }
}

/** A remesh that must do; what it says on stderr and in its report. */
function done(name, a, b, connectivity) {
  const file = recipe(name, a, b, connectivity);
  const report = join(scratch, name, 'report.json');
  const command = ['remesh', file, '-o', join(scratch, name, 'out'), '--sheet', 'none', '--report', report];
  const run = spawnSync(program, command, { encoding: 'utf8', timeout: SLOWNESS * 120000 });
  if (run.status !== 0) wrong(`${name}: exit code ${run.status}\n${run.stderr}`);
  return { text: run.stderr, report: existsSync(report) ? JSON.parse(readFileSync(report, 'utf8')) : { problems: [] } };
}

rmSync(scratch, { recursive: true, force: true });

// Everything that is wrong with all sources and their landmarks at once.
const without = (...faces) => (mesh) => ({ points: mesh.points, faces: mesh.faces.filter((_, f) => !faces.includes(f)) });
refused('all_at_once', 2, [
  '#/sources/a/landmarks/far: error: (9, 9, 9) is ', '[landmarks.off-surface]',
  '#/sources/b/landmarks/left: error: "front" and "left" lie at one point of "b" [landmarks.same-point]',
  '#/sources/a/landmarks: error: the sources have 2 landmarks in common; 3 are needed [landmarks.too-few]',
  '#/sources/a/landmarks: error: "a" lacks landmarks that other sources have: left, back [landmarks.missing]',
  '#/sources/b/landmarks: error: "b" lacks landmarks that other sources have: far [landmarks.missing]',
  'error: "a" has 2 holes, one of 3 edges at (', '[correspondence.holes]',
  'b.gltf: error: "b" has 1 handle, as a cup has; a remesh takes none [correspondence.handles]',
], ball(without(40, 200), { ...landmarks(undefined, ['top', 'front']), far: { position: [9, 9, 9] } }),
{ mesh: torus(12), landmarks: { top: { vertex: 0 }, front: { vertex: 7 }, left: { vertex: 7 }, back: { vertex: 60 } } });

// A surface that is no manifold does not hide what is wrong with landmarks, nor the other source's topology.
const finned = (mesh) => ({ points: [...mesh.points, [3, 3, 3]], faces: [...mesh.faces, [mesh.faces[0][0], mesh.faces[0][1], mesh.points.length]] });
refused('no_manifold', 4, [
  'a.gltf#/meshes/0: error: the surface is no oriented manifold: edge ', '[connectivity.not-manifold]',
  '#/sources/a/landmarks/top: error: ', '[landmarks.off-surface]', '[correspondence.pieces]',
], ball(finned, { ...landmarks(), top: { position: [0, 0, 40] } }), ball((mesh) => ({
  points: [...mesh.points, ...mesh.points.map((p) => p.map((x) => 0.1 * x + 2))],
  faces: [...mesh.faces, ...mesh.faces.map((face) => face.map((v) => v + mesh.points.length))],
})));
// A texture needs colours to show; that is told before the work.
refused('no_colours', 4, [
  '#/connectivity/texture/of: error: "b" has one colour everywhere', '[connectivity.no-colours]',
  'hint: name a source that has a texture, or leave the field "texture" out',
], ball(), good, { texture: { of: 'b', size: 64 } });
// New triangles of a resample are made on the first source, which must be a surface.
const squeezed = (change) => ({ mesh: sphere(16, 12, change), landmarks: {} });
const loose = { mesh: sphere(16, 12), landmarks: {} };
const resampled = { mode: 'resample' };
refused('resampled_line', 4, ['a.gltf#/meshes/0: error: the surface is no oriented manifold: ', '[connectivity.not-manifold]'],
  squeezed(([x, y, z]) => [x + 3 * y + 7 * z, 0, 0]), loose, resampled);
refused('resampled_flat', 4, ['a.gltf#/meshes/0: error: the surface is no oriented manifold: edge (', '[connectivity.not-manifold]'],
  squeezed(([x, y]) => [x, y, 0]), loose, resampled);
refused('resampled_point', 4, ['a.gltf#/meshes/0: error: the mesh has no triangle with three different corners [connectivity.empty]'],
  squeezed(() => [0, 0, 0]), loose, resampled);
const strip = { points: [0, 1, 2, 3, 4].map((x) => [x, x % 2, 0]), faces: [[0, 1, 2], [2, 1, 3], [2, 3, 4]] };
refused('resampled_strip', 4, ['a.gltf: error: "a" has pieces without area: at (0, 0, 0) [connectivity.no-area]'],
  { mesh: { ...strip, points: strip.points.map(([x]) => [x, 0, 0]) }, landmarks: {} }, { mesh: strip, landmarks: {} }, resampled);
// A triangle without area here and there is none to refuse; before, CGAL failed where edges beside it were hard.
const halved = ({ points, faces }) => {
  const mesh = { points: [...points], faces: [] };
  for (const [a, b, c] of faces) {
    const middle = mesh.points.push([0, 1, 2].map((k) => (points[a][k] + points[b][k]) / 2)) - 1;
    mesh.faces.push([a, b, middle], [a, middle, c], [middle, b, c]);
  }
  return mesh;
};
const flat_triangles = { mesh: halved(sphere(16, 12)), landmarks: {} };
if (done('resampled_halves', flat_triangles, flat_triangles, { mode: 'resample', max_error: 0.05, max_vertices: 3000, target_edge_length: 0.05 })
  .report.connectivity?.sources.some((source) => source.folds > 0)) wrong('resampled_halves: folds');
// One turned triangle is mended and told of; a strip that is twisted has no outside to turn to.
const turn_one = (mesh) => ({ points: mesh.points, faces: mesh.faces.map((face, f) => (f === 50 ? [face[0], face[2], face[1]] : face)) });
const mended = done('turned_triangle', ball(turn_one), good);
if (!mended.text.includes('warning: of "a": 1 triangle is turned')) wrong(`turned_triangle: not told\n${mended.text}`);
if (mended.report.connectivity?.repairs.map(({ turned: count }) => count).join() !== '1,0') wrong('turned_triangle: not in the report');
const moebius = { points: [], faces: [] };
for (let i = 0; i < 12; ++i) {
  const u = (2 * Math.PI * i) / 12, q = [2 * i, 2 * i + 1, ...(i < 11 ? [2 * i + 2, 2 * i + 3] : [1, 0])];
  for (const w of [-0.3, 0.3]) moebius.points.push([(1 + w * Math.cos(u / 2)) * Math.cos(u), (1 + w * Math.cos(u / 2)) * Math.sin(u), w * Math.sin(u / 2)]);
  moebius.faces.push([q[0], q[1], q[2]], [q[1], q[3], q[2]]);
}
refused('moebius', 4, [' is turned against its neighbour', '[connectivity.not-manifold]', 'hint: the surface has no outside there'],
  { mesh: moebius, landmarks: { top: { vertex: 0 }, front: { vertex: 5 }, left: { vertex: 10 }, back: { vertex: 15 } } }, good);
refused('open_and_closed', 4, ['error: "b" is closed but "a" is open (it has a border, one of 3 edges at (', '[correspondence.different-topology]'],
  ball(without(40)), good);
refused('inside_out', 4, ['a.gltf: error: "a" is inside out: ', '[correspondence.mirrored]', 'hint: in Blender: Mesh > Normals > Recalculate Outside'],
  ball(turned), good);
const mirrored = ([x, y, z]) => [-x, y, z];
refused('mirrored', 4, ['[correspondence.mirrored]', 'hint: swap its left and right landmarks, or mirror the mesh'],
  { mesh: turned(sphere(16, 12, mirrored)), landmarks: landmarks(mirrored) }, good);
const many = Object.fromEntries(Array.from({ length: 60 }, (_, i) => [`l${i}`, { vertex: 3 * i }]));
refused('no_room', 4, ['recipe.json#/connectivity/max_vertices: error: 60 landmarks need a vertex each; max_vertices is 50 [connectivity.too-many-vertices]'],
  ball(undefined, many), { ...good, landmarks: many }, { max_vertices: 50 });

// Vertices that are repeated are welded, those of no triangle passed over; a pole of 5000 neighbours takes no ages.
const soup = ({ points, faces }) => ({ points: [...faces.flatMap((face) => face.map((v) => points[v])), [50, 50, 50]], faces: faces.map((_, f) => [3 * f, 3 * f + 1, 3 * f + 2]) });
done('soup', ball(soup), good);
const poles = spawnSync(program, ['validate', recipe('poles', { mesh: sphere(5000, 2), landmarks: landmarks() }, good)], { encoding: 'utf8', timeout: SLOWNESS * 60000 });
if (poles.status !== 4 || !poles.stderr.includes('[correspondence.no-room]')) wrong(`poles: exit code ${poles.status}\n${poles.stderr}`);

// What the limit of vertices left undone is told, on stderr and in the report.
const { text, report } = done('limit', ball(), good, { max_vertices: 60, max_error: 0.001, target_edge_length: 0.05 });
for (const part of ['not within max_error (0.001); refinement ended at max_vertices (60) [connectivity.error-not-reached]', '[connectivity.edge-length-not-reached]']) {
  if (!text.includes(part)) wrong(`limit: stderr lacks ${part}\n${text}`);
}
if (!report.problems.some(({ code }) => code === 'connectivity.error-not-reached')) wrong('limit: the report has no such problem');
if (!(report.connectivity?.sources[0].longest_edge > 0.05)) wrong('limit: the report does not tell the longest edge');

// SIGTERM in the middle: soon over, and nothing is left.
const folder = join(scratch, 'stopped', 'out');
const file = recipe('stopped', { mesh: sphere(300, 150), landmarks: landmarks() }, good);
const child = spawn(program, ['remesh', file, '-o', folder], { stdio: ['ignore', 'ignore', 'pipe'] });
let stopped = 0;
child.stderr.on('data', (data) => {
  if (stopped || !data.toString().includes('correspondence')) return;
  stopped = Date.now();
  child.kill('SIGTERM');
});
child.on('exit', (code) => {
  const took = Date.now() - stopped;
  if (!stopped) wrong(`stopped: it was over before it could be, with exit code ${code}`);
  if (code !== 130) wrong(`stopped: exit code ${code}`);
  if (took > 8000) wrong(`stopped: took ${took} ms`);
  if (files_in(folder).length) wrong(`stopped: left ${files_in(folder)}`);
  console.log(failures ? `${failures} wrong` : 'all right');
  process.exit(failures ? 1 : 0);
});
