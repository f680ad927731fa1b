// Our compressed file is no larger than what gltfpack makes of our floats, and nearer to the motion: positions and
// normals at all frames and half-way between, read by code that shares nothing with what wrote it.
// Usage: node gltfpack_test.mjs --morphbake PROGRAM --meshes FOLDER     FOLDER: three ages of one body
import { spawnSync } from 'node:child_process';
import { existsSync, statSync, writeFileSync } from 'node:fs';
import path from 'node:path';
import { readAccessor } from './reference/glb.mjs';
import { openPlain } from './reference/plain.mjs';
import { cornersOf, sampleAt } from './reference/scene.mjs';
import { bake, modulesFolder, readArguments, skip, startChecks, withFolder } from './support.mjs';

const { morphbake, meshes } = readArguments('morphbake', 'meshes');
if (!existsSync(meshes)) skip(`${meshes} is not there`);
const checks = startChecks();

const sources = Object.fromEntries(['young', 'old', 'baby'].map((age) => [age, path.join(meshes, `mh_male_${age}.glb`)]));
const recipe = {
  version: 1, name: 'ages', units: 'scene', sources, hold: 'none',
  regions: { below: { spatial: { half_space: { normal: [0, 1, 0], offset: { keys: [{ time: 0, value: -10 }, { time: 2, value: 11 }] } }, width: 3 } } },
  timeline: { fps: 60, tracks: ['old', 'baby'].map((name) => ({ name, region: 'below', to: name, begin: 0, end: 2, ease: 'linear' })) },
  outputs: [{ file: 'frames.glb', targets: 'frames' }, { file: 'float.glb', targets: 'basis', encoding: 'float' },
    { file: 'small.glb', targets: 'basis', encoding: 'meshopt' }] };

/** Base and targets of the only primitive in the scene, whose node is scaled alike in all directions and not turned. */
async function openMorph(file) {
  const plain = await openPlain(file);
  const { json } = plain;
  const holder = json.nodes.find(({ mesh }) => mesh !== undefined);
  const { scale = [1, 1, 1], translation = [0, 0, 0], rotation } = holder;
  checks.check(!rotation && scale.every((s) => s === scale[0]), `${file}: the node is turned or not scaled alike`);
  const [primitive] = json.meshes[holder.mesh].primitives;
  const place = (rows) => rows.map((x, i) => scale[0] * x + translation[i % 3]);
  const base = place(readAccessor(plain, primitive.attributes.POSITION));
  const moves = primitive.targets.map(({ POSITION }) => readAccessor(plain, POSITION).map((x) => scale[0] * x));
  const normals = readAccessor(plain, primitive.attributes.NORMAL);
  const turns = primitive.targets.map(({ NORMAL }) => readAccessor(plain, NORMAL));
  const { samplers: [sampler] } = json.animations[0];
  const times = readAccessor(plain, sampler.input);
  const sum = (rest, deltas, weights) => {
    const rows = Float64Array.from(rest);
    weights.forEach((weight, k) => { if (weight !== 0) for (let i = 0; i < rows.length; i++) rows[i] += weight * deltas[k][i]; });
    return rows;
  };
  const at = (time) => { const weights = sampleAt(plain, sampler, 'weights', time); return { positions: sum(base, moves, weights), normals: sum(normals, turns, weights) }; };
  return { at, times, corners: cornersOf(plain, primitive) };
}

const apart = (a, i, b, j) => Math.hypot(a[3 * i] - b[3 * j], a[3 * i + 1] - b[3 * j + 1], a[3 * i + 2] - b[3 * j + 2]);

/** For each vertex of `to` the one of `from` that starts and ends where it does, and whose normal starts likewise. */
function matchVertices(from, to, end, reach) {
  const [a, b] = [from, to].map((morph) => ({ first: morph.at(0), last: morph.at(end) }));
  const cells = new Map();
  const cell = (rows, i, axis) => Math.floor(rows[3 * i + axis] / reach);
  for (const i of new Set(from.corners)) {
    const key = [0, 1, 2].map((axis) => cell(a.first.positions, i, axis)).join();
    cells.set(key, [...(cells.get(key) ?? []), i]);
  }
  return [...new Set(to.corners)].map((j) => {
    let best = { off: Infinity };
    for (let n = 0; n < 27; n++) {
      const key = [n % 3, Math.floor(n / 3) % 3, Math.floor(n / 9)].map((d, axis) => cell(b.first.positions, j, axis) + d - 1).join();
      for (const i of cells.get(key) ?? []) {
        const off = apart(a.first.positions, i, b.first.positions, j) + apart(a.last.positions, i, b.last.positions, j) +
          reach * apart(a.first.normals, i, b.first.normals, j);
        if (off < best.off) best = { off, i, j };
      }
    }
    return best;
  });
}

/** Largest distance, and the angles' root mean square, 99th percentile and largest, to the motion frame by frame. */
function measure(frames, morph) {
  const end = frames.times.at(-1);
  const pairs = matchVertices(frames, morph, end, 0.1);
  checks.check(pairs.every(({ off }) => off < 0.3), 'a vertex has no counterpart');
  let distance = 0, squares = 0;
  const angles = [];
  [...frames.times].flatMap((time, f, all) => (f ? [(all[f - 1] + time) / 2, time] : [time])).forEach((time) => {
    const exact = frames.at(time), shown = morph.at(time);
    for (const { i, j } of pairs) {
      distance = Math.max(distance, apart(exact.positions, i, shown.positions, j));
      const [p, q] = [[exact.normals, i], [shown.normals, j]].map(([rows, k]) => [rows[3 * k], rows[3 * k + 1], rows[3 * k + 2]]);
      const cross = Math.hypot(p[1] * q[2] - p[2] * q[1], p[2] * q[0] - p[0] * q[2], p[0] * q[1] - p[1] * q[0]);
      const angle = Math.atan2(cross, p[0] * q[0] + p[1] * q[1] + p[2] * q[2]) * 180 / Math.PI;
      squares += angle * angle;
      angles.push(angle);
    }
  });
  const sorted = Float64Array.from(angles).sort();
  return { distance, rms: Math.sqrt(squares / sorted.length), most: sorted[Math.floor(0.99 * sorted.length)], largest: sorted.at(-1) };
}

await withFolder(async (folder) => {
  const file = path.join(folder, 'ages.json');
  writeFileSync(file, JSON.stringify(recipe));
  bake(morphbake, file, folder);
  const packed = path.join(folder, 'packed.glb');
  const run = spawnSync(process.execPath, [path.join(modulesFolder(), 'gltfpack', 'cli.js'), '-c', '-af', '0', '-i', path.join(folder, 'float.glb'), '-o', packed], { encoding: 'utf8' });
  checks.check(run.status === 0, `gltfpack: ${run.stdout}${run.stderr}`);
  const frames = await openMorph(path.join(folder, 'frames.glb'));
  const found = {};
  for (const name of ['float', 'packed', 'small']) {
    const glb = path.join(folder, `${name}.glb`);
    found[name] = { size: statSync(glb).size, ...measure(frames, await openMorph(glb)) };
    const { size, distance, rms, most, largest } = found[name];
    console.log(`${name}: ${size} bytes, ${distance.toExponential(3)} off, normals ${rms.toFixed(3)} rms, ${most.toFixed(3)} for 99 in 100, ${largest.toFixed(2)} at most`);
  }
  const { packed: theirs, small: ours } = found;
  checks.check(ours.size <= theirs.size, `${ours.size} bytes, gltfpack ${theirs.size}`);
  for (const error of ['distance', 'rms', 'most', 'largest']) checks.check(ours[error] <= theirs[error], `${error}: ${ours[error]}, gltfpack ${theirs[error]}`);
});
checks.finish('gltfpack');
