// One morph in every encoding: each shows what the floats show, in fewer bytes, read by code that shares nothing with
// what wrote them. What is baked stays in FOLDER, for the clients.
// Usage: node encodings_test.mjs --morphbake PROGRAM --output FOLDER
import { mkdirSync, rmSync, statSync, writeFileSync } from 'node:fs';
import path from 'node:path';
import { openPlain } from './reference/plain.mjs';
import { readAccessor } from './reference/glb.mjs';
import { evaluateScene } from './reference/scene.mjs';
import { at, diagonal, distance } from './reference/vectors.mjs';
import { bake, placeRecipe, readArguments, startChecks, withFolder } from './support.mjs';

const { morphbake, output } = readArguments('morphbake', 'output');
const checks = startChecks();
const TIMES = [0, 0.3, 0.5, 0.77, 1];
const STEP = 1 / 32767 / 2; // of the cube about the mesh: what rounding to 16 bits moves a number by

const ENCODINGS = {
  float: { encoding: 'float' },
  sparse: {},
  quantized: { encoding: 'quantized' },
  meshopt: { encoding: 'meshopt' },
};
const outputs = (targets) => Object.entries(ENCODINGS).map(([name, fields]) => ({ file: `${name}.glb`, targets, ...fields }));
const ball = (at_) => ({ ball: { on: 'orb', at: at_, inner: 0.1, outer: 0.3 } });
const RECIPES = {
  // A part that moves: sparse targets, and one that keeps still in the second primitive of the drum.
  sparse: { version: 1, name: 'sparse', sources: { orb: 'orb.glb', nosed: 'orb-nose.glb' }, regions: { nose: ball('nose') },
    timeline: { fps: 8, tracks: [{ name: 'nose', region: 'nose', to: 'nosed', begin: 0, end: 1 }] }, outputs: outputs('tracks') },
  // All of it moves, two primitives.
  dense: { version: 1, name: 'dense', representation: 'laplacian', sources: { drum: 'drum.glb', bent: 'drum-bent.glb' },
    timeline: { fps: 8, tracks: [{ name: 'all', to: 'bent', begin: 0, end: 1 }] }, outputs: outputs('tracks') },
  // Several shapes at a time whose base is no frame.
  basis: { version: 1, name: 'basis', units: 'scene', hold: 'none', sources: { orb: 'orb.glb', long: 'orb-long.glb' },
    regions: { below: { spatial: { half_space: { normal: [0, 0, 1], offset: { keys: [{ time: 0, value: -1.3 }, { time: 1, value: 1.3 }] } }, width: 0.4 } } },
    timeline: { fps: 16, tracks: [{ name: 'all', region: 'below', to: 'long', begin: 0, end: 1 }] }, outputs: outputs('basis') },
};

/** Corner positions of each primitive, triangle by triangle; compressed files have them in another order. */
const cornersOf = (plain, time) => evaluateScene(plain, { animation: 0, time }).flatMap(({ primitives }) =>
  primitives.map(({ positions, corners }) => ({ size: diagonal(positions), places: corners.map((i) => at(positions, i)) })));

/** For each corner of `to` the one of `from` that is at its place in all moments, found by the first and the last. */
function matchCorners(from, to, tolerance) {
  const cells = new Map();
  const keyOf = (places, [dx, dy, dz] = [0, 0, 0]) => [0, 1, 2].map((axis) => Math.floor(places[axis] / tolerance) + [dx, dy, dz][axis]).join();
  from.first.forEach((place, i) => { const key = keyOf(place); cells.set(key, [...(cells.get(key) ?? []), i]); });
  return to.first.map((place, c) => {
    let best = { off: Infinity };
    for (const dx of [-1, 0, 1]) for (const dy of [-1, 0, 1]) for (const dz of [-1, 0, 1])
      for (const i of cells.get(keyOf(place, [dx, dy, dz])) ?? []) {
        const off = distance(from.first[i], place) + distance(from.last[i], to.last[c]);
        if (off < best.off) best = { off, i };
      }
    return best.i;
  });
}

/** How far corners are from those of the floats, of the diagonal; and whether there are as many triangles. */
function farthest(floats, plain, bound) {
  let far = 0;
  const [first, last] = [TIMES[0], TIMES.at(-1)].map((time) => [floats, plain].map((file) => cornersOf(file, time)));
  for (const time of TIMES) {
    const expected = cornersOf(floats, time), found = cornersOf(plain, time);
    expected.forEach(({ size, places }, p) => {
      checks.check(places.length === found[p].places.length, 'triangles are lost');
      const match = matchCorners({ first: first[0][p].places, last: last[0][p].places },
        { first: first[1][p].places, last: last[1][p].places }, Math.max(4 * bound, 1e-6) * size);
      found[p].places.forEach((place, c) => { far = Math.max(far, match[c] === undefined ? Infinity : distance(places[match[c]], place) / size); });
    });
  }
  return far;
}

/** Accessors of POSITION and NORMAL of the mesh and its targets. */
function accessorsOf({ json }) {
  return json.meshes[0].primitives.flatMap(({ attributes, targets }) => [attributes, ...targets].flatMap((fields) =>
    ['POSITION', 'NORMAL'].filter((name) => name in fields).map((name) => ({ name, index: fields[name], isTarget: fields !== attributes, ...json.accessors[fields[name]] }))));
}

function checkIntegers(name, plain) {
  const { json } = plain;
  checks.check(json.extensionsRequired?.includes('KHR_mesh_quantization'), `${name}: does not say that it is quantized`);
  for (const { componentType, normalized, bufferView, index, isTarget, name: attribute } of accessorsOf(plain)) {
    const values = readAccessor(plain, index);
    const largest = values.reduce((most, x) => Math.max(most, Math.abs(x)), 0);
    if (componentType === 5126) {
      const isLarge = attribute === 'NORMAL' && largest > 1;
      checks.check(isTarget && (largest === 0 || isLarge), `${name}: ${attribute} ${index} is float`);
      continue;
    }
    const isSmall = attribute === 'NORMAL' && name.endsWith('meshopt');
    checks.check(componentType === (isSmall ? 5120 : 5122) && normalized, `${name}: ${attribute} ${index} is of type ${componentType}`);
    checks.check(largest <= 1, `${name}: ${attribute} ${index} reaches ${largest}`);
    if (bufferView !== undefined) checks.check(json.bufferViews[bufferView].byteStride === (isSmall ? 4 : 8), `${name}: stride ${json.bufferViews[bufferView].byteStride}`);
  }
  const scaled = json.nodes.filter(({ scale, mesh }) => scale && mesh !== undefined);
  checks.check(scaled.length === 1 && !scaled[0].children && scaled[0].skin === undefined, `${name}: the scale is not on a node of its own`);
}

rmSync(output, { recursive: true, force: true });
for (const [recipe, json] of Object.entries(RECIPES)) {
  await withFolder(async (folder) => {
    const file = path.join(folder, 'recipe.json');
    writeFileSync(file, JSON.stringify(json));
    const baked = path.join(output, recipe);
    mkdirSync(baked, { recursive: true });
    const { outputs: reports } = bake(morphbake, placeRecipe(file, path.join(folder, 'placed')), baked);
    const floats = await openPlain(path.join(baked, 'float.glb'));
    const size = statSync(path.join(baked, 'float.glb')).size;
    const isSparse = (plain) => accessorsOf(plain).some(({ sparse, isTarget }) => sparse && isTarget);
    checks.check(!isSparse(floats), `${recipe}: floats are sparse`);
    if (recipe === 'sparse') checks.check(isSparse(await openPlain(path.join(baked, 'sparse.glb'))), 'no target is sparse');
    for (const [index, encoding] of Object.keys(ENCODINGS).entries()) {
      const name = `${recipe}/${encoding}`;
      const glb = path.join(baked, `${encoding}.glb`);
      const plain = await openPlain(glb);
      const isInteger = encoding === 'quantized' || encoding === 'meshopt';
      const targets = reports[index].targets.length;
      // Base and targets are rounded by half a step an axis, in a cube that is at most twice as wide as the mesh here.
      // Where bytes count too, steps are a fifth of max_error.
      const step = encoding === 'meshopt' ? 2e-4 / 2 : 2 * STEP;
      const bound = isInteger ? step * Math.sqrt(3) * (1 + targets) : 0;
      const far = farthest(floats, plain, bound);
      console.log(`${name}: ${statSync(glb).size} of ${size} bytes, ${far.toExponential(1)} off, normals ${reports[index].normals.percentile_99.toFixed(3)}`);
      checks.check(far <= bound, `${name}: ${far} off, more than ${bound}`);
      // Small integers and what may not exceed 1 cost the worst few normals most.
      checks.check(reports[index].normals.percentile_99 <= reports[0].normals.percentile_99 + (encoding === 'meshopt' ? 1 : 0.02), `${name}: normals`);
      checks.check(encoding === 'float' || (encoding === 'sparse' && recipe !== 'sparse') || statSync(glb).size < size, `${name}: is not smaller`);
      if (isInteger) checkIntegers(name, plain);
      checks.check((encoding === 'meshopt') === Boolean(plain.written.extensionsRequired?.includes('EXT_meshopt_compression')), `${name}: extensions`);
    }
  });
}
checks.finish('encodings');
