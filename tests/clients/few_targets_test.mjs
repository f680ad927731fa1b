// A motion as keyframes, as a basis, and as `auto` takes it, beside the same motion frame by frame, read by code that
// shares nothing with what wrote it: within the bounds, and as the report says.
// Usage: node few_targets_test.mjs --morphbake PROGRAM [--meshes FOLDER]     FOLDER: three ages of one body
import { existsSync, readFileSync, writeFileSync } from 'node:fs';
import path from 'node:path';
import { parseArgs } from 'node:util';
import { findMeshNode, parseGlb, readAccessor } from './reference/glb.mjs';
import { sampleAt } from './reference/scene.mjs';
import { bake, placeRecipe, startChecks, withFolder } from './support.mjs';

const { values: { morphbake, meshes } } = parseArgs({ options: { morphbake: { type: 'string' }, meshes: { type: 'string' } } });
const checks = startChecks();
const ROUNDING = 2e-7; // of the diagonal: float32 positions and their sums

/** The weights animation, which is LINEAR. */
function weightsOf(glb) {
  const { channels, samplers } = glb.json.animations[0];
  const sampler = samplers[channels.find(({ target }) => target.path === 'weights').sampler];
  checks.check(sampler.interpolation === 'LINEAR', `weights are ${sampler.interpolation}`);
  const times = readAccessor(glb, sampler.input), values = readAccessor(glb, sampler.output);
  return { times, values, at: (time) => sampleAt(glb, sampler, 'weights', time) };
}

/** A file's motion: rows of POSITION or NORMAL of its only primitive at a time. */
function openMotion(file) {
  const glb = parseGlb(readFileSync(file));
  const weights = weightsOf(glb);
  const mesh = glb.json.meshes[findMeshNode(glb).node.mesh];
  const [{ attributes, targets }] = mesh.primitives;
  const read = (name) => ({ base: readAccessor(glb, attributes[name]), moves: targets.map((target) => readAccessor(glb, target[name])) });
  const parts = { POSITION: read('POSITION'), NORMAL: read('NORMAL') };
  const rowsAt = (name, time) => {
    const rows = Float64Array.from(parts[name].base);
    weights.at(time).forEach((weight, k) => {
      const move = parts[name].moves[k];
      if (weight !== 0) for (let i = 0; i < rows.length; i++) rows[i] += weight * move[i];
    });
    return rows;
  };
  return { weights, targets: targets.length, names: mesh.extras.targetNames, first: mesh.weights, rowsAt, base: parts.NORMAL.base };
}

const lengthOf = (rows, i) => Math.hypot(rows[i], rows[i + 1], rows[i + 2]);

function diagonalOf(rows) {
  const low = [Infinity, Infinity, Infinity], high = [-Infinity, -Infinity, -Infinity];
  rows.forEach((x, i) => { low[i % 3] = Math.min(low[i % 3], x); high[i % 3] = Math.max(high[i % 3], x); });
  return Math.hypot(...high.map((x, axis) => x - low[axis]));
}

/** The largest distance and angle between two motions, at the frames of the second and half-way between. */
function compare(motion, frames) {
  const diagonal = diagonalOf(frames.rowsAt('POSITION', 0));
  const worst = { distance: 0, angle: 0, first: 0 };
  const times = [...frames.weights.times].flatMap((time, f, all) => (f ? [(all[f - 1] + time) / 2, time] : [time]));
  for (const time of times) {
    const a = motion.rowsAt('POSITION', time), b = frames.rowsAt('POSITION', time);
    for (let i = 0; i < a.length; i += 3) {
      const distance = Math.hypot(a[i] - b[i], a[i + 1] - b[i + 1], a[i + 2] - b[i + 2]) / diagonal;
      if (distance > worst.distance) Object.assign(worst, { distance, time, vertex: i / 3 });
      if (time === 0) worst.first = Math.max(worst.first, distance);
    }
  }
  return worst;
}

function checkOutput(name, motion, report, frames, bound) {
  const { distance, first } = compare(motion, frames);
  console.log(`${name}: ${motion.targets} targets (${report.kind}), error ${distance.toExponential(2)}, report ${report.max_error.toExponential(2)}; normals ${report.normals.maximum.toFixed(2)}, ${report.normals.percentile_99.toFixed(2)} degrees`);
  checks.check(distance <= bound + ROUNDING, `${name}: ${distance} is more than ${bound}`);
  checks.check(Math.abs(distance - report.max_error) <= ROUNDING, `${name}: the report says ${report.max_error}, it is ${distance}`);
  checks.check(first <= ROUNDING * 10, `${name}: the first frame is ${first} off`);
  checks.check(motion.targets === report.targets.length, `${name}: the report counts ${report.targets.length} targets`);
  checks.check(motion.weights.values.every((w) => w >= 0 && w <= 1), `${name}: weights leave [0, 1]`);
  checks.check(motion.first.length === motion.targets, `${name}: mesh.weights has ${motion.first.length} numbers`);
  motion.weights.at(0).forEach((w, k) => checks.check(Math.abs(w - motion.first[k]) < 1e-6, `${name}: mesh.weights is not the first frame`));
  for (let i = 0; i < motion.base.length; i += 3)
    if (Math.abs(lengthOf(motion.base, i) - 1) > 1e-4) { checks.check(false, `${name}: base normal ${i / 3} has length ${lengthOf(motion.base, i)}`); break; }
}

/** Bakes all kinds of one recipe and checks each. @return targets of each kind */
function checkKinds(recipe, folder, bound, smoothBound) {
  const kinds = ['frames', 'keyframes', 'basis', 'auto'];
  const outputs = [...kinds.map((targets) => ({ file: `${targets}.glb`, targets, max_error: bound })),
    { file: 'smooth.glb', targets: 'basis', max_error: bound, max_normal_error: { percentile_99: smoothBound } }];
  const file = path.join(folder, 'recipe.json');
  writeFileSync(file, JSON.stringify({ ...recipe, outputs }));
  const isHere = Object.values(recipe.sources).every((source) => path.isAbsolute(source));
  const placed = isHere ? file : placeRecipe(file, path.join(folder, 'placed'));
  const { outputs: reports } = bake(morphbake, placed, path.join(folder, 'out'));
  const frames = openMotion(path.join(folder, 'out', 'frames.glb'));
  const counts = Object.fromEntries(outputs.map(({ file: name }, i) => {
    const motion = openMotion(path.join(folder, 'out', name));
    checkOutput(name, motion, reports[i], frames, name === 'frames.glb' ? ROUNDING : bound);
    return [name, motion.targets];
  }));
  checks.check(counts['auto.glb'] === Math.min(counts['keyframes.glb'], counts['basis.glb']), 'auto takes the more');
  checks.check(counts['keyframes.glb'] < counts['frames.glb'], 'keyframes are as many as frames');
  checks.check(counts['smooth.glb'] > counts['basis.glb'], 'a bound on normals adds no targets');
  checks.check(reports[4].normals.percentile_99 <= smoothBound, `normals are ${reports[4].normals.percentile_99} degrees off`);
  return counts;
}

/** A plane that runs over the first source in two seconds and leaves the others below it. */
const sweep = (sources, { fps, normal, from, to, width }) => ({
  version: 1, name: 'few', units: 'scene', sources, hold: 'none',
  regions: { below: { spatial: { half_space: { normal, offset: { keys: [{ time: 0, value: from }, { time: 2, value: to }] } }, width } } },
  timeline: { fps, tracks: Object.keys(sources).slice(1).map((name) => ({ name, region: 'below', to: name, begin: 0, end: 2, ease: 'linear' })) } });

await withFolder((folder) => {
  checkKinds(sweep({ orb: 'orb.glb', long: 'orb-long.glb' }, { fps: 30, normal: [0, 0, 1], from: -1.3, to: 1.3, width: 0.3 }), folder, 1e-3, 0.1);
});
if (meshes && existsSync(meshes)) {
  await withFolder((folder) => {
    const sources = Object.fromEntries(['young', 'old', 'baby'].map((age) => [age, path.join(meshes, `mh_male_${age}.glb`)]));
    checkKinds(sweep(sources, { fps: 60, normal: [0, 1, 0], from: -10, to: 11, width: 3 }), folder, 1e-3, 0.4);
  });
} else console.log('the ages of ../shared are not there');
checks.finish('few targets');
