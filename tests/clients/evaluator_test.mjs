// The evaluator itself: a small file of known numbers, written here, comes back from three.js as computed.
// Usage: node evaluator_test.mjs
import { openPage } from './browser.mjs';
import { drawGltf, evaluateGltf } from './evaluate_gltf.mjs';
import { at, distance, unit } from './reference/vectors.mjs';
import { floats, indices, packGlb } from './shapes/write_glb.mjs';
import { startChecks } from './support.mjs';

const POINTS = [[0, 0, 0], [1, 0, 0], [0, 1, 0]];
const NORMALS = [[0, 0, 1], [0, 0, 1], [0, 0, 1]];
const LIFT = [[0, 0, 1], [0, 0, 0], [0, 0, 0]];
const LIFT_NORMALS = [[0.5, 0.5, -0.25], [0, 0, 0], [0, 0, 0]];
const SPREAD = [[0, 0, 0], [2, 0, 0], [0, 2, 0]];
const NO_NORMALS = [[0, 0, 0], [0, 0, 0], [0, 0, 0]];

/** Two primitives, two targets; "lift" is 0, 1, 0.5 and "spread" 0, 0, 1 at 0, 1, 2 s; scaled by 1, 2, 3. */
function writeFile() {
  const accessors = [POINTS, NORMALS, LIFT, LIFT_NORMALS, SPREAD, NO_NORMALS].map((rows) => floats(rows, 3));
  accessors.push(indices([0, 1, 2]), floats([0, 1, 2], 1, 0), floats([0, 0, 1, 0, 0.5, 1], 1, 0));
  const primitive = { attributes: { POSITION: 0, NORMAL: 1 }, indices: 6,
    targets: [{ POSITION: 2, NORMAL: 3 }, { POSITION: 4, NORMAL: 5 }] };
  return packGlb({
    scene: 0, scenes: [{ nodes: [0] }], nodes: [{ mesh: 0, scale: [1, 2, 3], translation: [10, 0, 0] }],
    meshes: [{ primitives: [primitive, primitive], weights: [0, 0], extras: { targetNames: ['lift', 'spread'] } }],
    animations: [{ channels: [{ sampler: 0, target: { node: 0, path: 'weights' } }], samplers: [{ input: 7, output: 8 }] }],
  }, accessors);
}

function expectMoment(lift, spread, i) {
  const position = POINTS[i].map((x, k) => x + lift * LIFT[i][k] + spread * SPREAD[i][k]);
  const normal = NORMALS[i].map((x, k) => x + lift * LIFT_NORMALS[i][k]);
  return { position: [10 + position[0], 2 * position[1], 3 * position[2]],
    normal: unit([normal[0], normal[1] / 2, normal[2] / 3]) };
}

const MOMENTS = [[0, 0, 0], [0.25, 0.25, 0], [1, 1, 0], [1.5, 0.75, 0.5], [2, 0.5, 1]];

const checks = startChecks();
const browser = await openPage();
const played = await evaluateGltf(browser, writeFile(), MOMENTS.map(([time]) => time));
checks.check(played.targets.join() === 'lift,spread', `targets: ${played.targets}`);
checks.check(played.primitives.length === 2, `${played.primitives.length} primitives`);
checks.check(played.complaints.length === 0, `complaints: ${played.complaints}`);
MOMENTS.forEach(([time, lift, spread], k) => {
  for (const primitive of [0, 1])
    for (const i of [0, 1, 2]) {
      const { position, normal } = expectMoment(lift, spread, i);
      const [p, n] = [at(played.positionsAt(k)[primitive], i), at(played.normalsAt(k)[primitive], i)];
      checks.check(distance(p, position) < 1e-9, `${time} s, vertex ${i}: ${p}, expected ${position}`);
      checks.check(distance(n, normal) < 1e-9, `${time} s, vertex ${i}: normal ${n}, expected ${normal}`);
    }
});
const picture = await drawGltf(browser, writeFile(), 2, 128);
checks.check(picture.length > 500, 'WebGL drew nothing');
await browser.close();
checks.finish(`${MOMENTS.length} moments as computed by hand, picture of ${picture.length} bytes`);
