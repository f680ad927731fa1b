// The reference against closed forms.
// Usage: node reference_test.mjs
import { fileURLToPath } from 'node:url';
import { writeFileSync } from 'node:fs';
import path from 'node:path';
import { cornersOf, expectOutput, frameTimes, openRecipe, solveShape } from './reference_frames.mjs';
import { rotateSmallest } from './reference/normals.mjs';
import { angle, at, diagonal, distance } from './reference/vectors.mjs';
import { placeRecipe, startChecks, withFolder } from './support.mjs';

const checks = startChecks();
const RECIPES = path.join(path.dirname(fileURLToPath(import.meta.url)), 'recipes');

/** Largest distance of two shapes as a fraction of the diagonal. */
function offBy(shape, expected) {
  let far = 0;
  for (let i = 0; i < shape.length / 3; i++) far = Math.max(far, distance(at(shape, i), at(expected, i)));
  return far / diagonal(expected);
}

function near(value, expected, tolerance, what) {
  checks.check(Math.abs(value - expected) <= tolerance, `${what}: ${value}, expected ${expected}`);
}

/** A recipe over the orbs with `changes`, opened. */
async function withOrbs(changes, work) {
  const recipe = { version: 1, name: 'orbs', sources: { orb: 'orb.glb', long: 'orb-long.glb', nosed: 'orb-nose.glb' },
    outputs: [], ...changes };
  await withFolder((folder) => {
    const file = path.join(folder, 'orbs.json');
    writeFileSync(file, JSON.stringify(recipe));
    work(openRecipe(placeRecipe(file, path.join(folder, 'placed'))));
  });
}

const everywhere = (ease) => ({ timeline: { fps: 4, tracks: [{ to: 'long', begin: 0, end: 1, ease }] } });

await withOrbs(everywhere('linear'), (opened) => {
  const { geometries } = opened.mesh;
  near(offBy(solveShape(opened, 0), geometries[0]), 0, 1e-11, 'T = e_0 gives V_0');
  near(offBy(solveShape(opened, 'nosed'), geometries[2]), 0, 1e-11, 'T = e_2 gives V_2');
  const blend = geometries[0].map((x, k) => 0.75 * x + 0.25 * geometries[1][k]);
  near(offBy(solveShape(opened, 0.25), blend), 0, 1e-11, 'uniform T gives the linear blend');
  const { normals } = cornersOf(opened, geometries[0]);
  const turned = Math.max(...Array.from(opened.mesh.corners, (_, c) => angle(at(normals, c), at(opened.sources[0].normals, c))));
  near(turned, 0, 1e-12, 'the first source keeps its normals');
  checks.check(frameTimes(opened).join() === '0,0.25,0.5,0.75,1', 'frame times');
});

for (const [ease, share] of [['linear', 0.25], ['step', 0], ['smoothstep', 0.15625], ['cubic', 0.0625]])
  await withOrbs(everywhere(ease), (opened) => {
    const [a, b] = opened.mesh.geometries;
    const blend = a.map((x, k) => (1 - share) * x + share * b[k]);
    near(offBy(solveShape(opened, 0.25), blend), 0, 1e-11, `ease ${ease}`);
    near(offBy(solveShape(opened, 1), b), 0, 1e-11, `ease ${ease} arrives`);
  });

// A state between sources that differ by a translation only moves nothing: differences do not see it.
await withOrbs({
  sources: { orb: 'orb.glb', moved: 'orb-moved.glb' },
  regions: { nose: { ball: { on: 'orb', at: 'nose', inner: 0.1, outer: 0.3, distance: 'edges' } } },
  timeline: { tracks: [{ region: 'nose', to: 'moved', begin: 0, end: 1 }] },
}, (opened) => {
  near(offBy(solveShape(opened, 1), opened.mesh.geometries[0]), 0, 1e-7, 'a translated source moves nothing');
});

// Distances along edges, counted by hand on the drum: the region's source is scaled, so is its diagonal.
await withFolder((folder) => {
  const opened = openRecipe(placeRecipe(path.join(RECIPES, 'keys_and_edits.json'), folder));
  checks.check(opened.mesh.neighbours.length === 11 * 24 + 2 * (24 + 1), 'the drum welds along its seam and rims');
  const expected = expectOutput(opened, { targets: 'tracks' });
  const at1 = expected.shapes[expected.times.indexOf(1)];
  const [drum, bent] = opened.mesh.geometries;
  near(offBy(at1, drum.map((x, k) => (x + bent[k]) / 2)), 0, 1e-10, 'the key at 1 s is its mix');
  const before = expected.times.findIndex((t) => t > 1.45 && t < 1.5);
  near(offBy(expected.shapes[before], at1), 0, 1e-10, 'a step holds the key before');
  near(offBy(expected.shapes[expected.times.indexOf(1.5)], opened.mesh.geometries[2]), 0, 1e-10, 'and jumps at its time');
});

await withFolder((folder) => {
  const opened = openRecipe(placeRecipe(path.join(RECIPES, 'two_components.json'), folder));
  const shape = solveShape(opened, 0.9);
  const { component, geometries } = opened.mesh;
  let far = 0;
  component.forEach((c, i) => { if (c === 1) far = Math.max(far, distance(at(shape, i), at(geometries[0], i))); });
  near(far, 0, 1e-10, 'a component that no track touches stays');
  near(geometries[0][0], 3 - 1.35, 1e-6, 'a mirrored node');
  const { normals } = cornersOf(opened, geometries[0]);
  checks.check(normals[0] < -0.99, `a mirrored node's normals point outwards: ${at(normals, 0)}`);
});

near(distance(rotateSmallest([1, 0, 0], [0, 1, 0], [0, 1, 0]), [-1, 0, 0]), 0, 1e-15, 'a quarter turn');
near(distance(rotateSmallest([1, 0, 0], [0, 1, 0], [0, 0, 1]), [0, 0, 1]), 0, 1e-15, 'its axis stays');
checks.finish('closed forms');
