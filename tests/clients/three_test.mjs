// Bakes recipes by the command line, plays the files in three.js and compares every frame and every
// middle between frames with the reference.
// Usage: node three_test.mjs --morphbake PROGRAM RECIPE...
import { readFileSync } from 'node:fs';
import path from 'node:path';
import { openPage } from './browser.mjs';
import { evaluateGltf } from './evaluate_gltf.mjs';
import { cornersOf, expectOutput, openRecipe } from './reference_frames.mjs';
import { angle, at, diagonal, distance } from './reference/vectors.mjs';
import { bake, placeRecipe, readArguments, startChecks, withFolder } from './support.mjs';

const POSITION_TOLERANCE = 1e-5;  // fraction of the first frame's diagonal
const NORMAL_SLACK = 0.05;  // degrees: float32 normals and key times

const { morphbake, files } = readArguments('morphbake');
const checks = startChecks();

/** The larger of two measurements, with where it was found. */
const worse = (a, b) => (b.value > a.value || Number.isNaN(b.value) ? b : a);

/** Compares one moment, corner by corner: the order of render vertices is the writer's own business. */
function compareMoment(expected, played, moment) {
  const positions = played.positionsAt(moment);
  const normals = played.normalsAt(moment);
  let [far, turned] = [{ value: 0 }, { value: 0 }];
  let corner = 0;
  played.primitives.forEach(({ indices }, primitive) => {
    for (const i of indices) {
      const where = { primitive, vertex: i, moment };
      far = worse(far, { value: distance(at(positions[primitive], i), at(expected.positions, corner)), ...where });
      const normal = at(expected.normals, corner++);
      if (Number.isNaN(normal[0])) continue;
      turned = worse(turned, { value: angle(at(normals[primitive], i), normal) * 180 / Math.PI, ...where });
    }
  });
  return { far, turned };
}

function compareLayout(name, opened, played) {
  const expected = opened.sources[0].primitiveCorners;
  const found = played.primitives.map(({ indices }) => indices.length);
  for (const complaint of played.complaints) checks.check(false, `${name}: the browser says: ${complaint}`);
  return checks.check(expected.join() === found.join(), `${name}: corners of primitives ${found}, expected ${expected}`);
}

async function compareOutput(browser, opened, output, report, file) {
  const { times, shapes } = expectOutput(opened, output);
  // Key times in a file are float32; a step at 0.3 s must be asked for at the same rounding of 0.3.
  const played = await evaluateGltf(browser, readFileSync(file), times.map(Math.fround));
  if (!compareLayout(output.file, opened, played)) return;
  checks.check(played.clips.length === (output.still ? 0 : 1), `${output.file}: ${played.clips.length} clips`);
  checks.check(played.targets.join() === (report?.targets ?? []).join(), `${output.file}: targets ${played.targets}, report: ${report?.targets}`);
  let [far, turned] = [{ value: 0 }, { value: 0 }];
  shapes.forEach((shape, moment) => {
    const found = compareMoment(cornersOf(opened, shape), played, moment);
    [far, turned] = [worse(far, found.far), worse(turned, found.turned)];
  });
  judge(output.file, { far, turned, times }, diagonal(shapes[0]), report);
}

function judge(name, { far, turned, times }, scale, report) {
  const [distanceFound, turnAllowed] = [far.value / scale, (report?.normals.maximum ?? 0) + NORMAL_SLACK];
  const place = ({ primitive, vertex, moment }) =>
    (primitive === undefined ? '' : ` (primitive ${primitive}, vertex ${vertex}, ${times[moment]} s)`);
  const middle = times.length > 1 ? `${(times.length + 1) / 2} frames and ${(times.length - 1) / 2} middles` : 'still';
  console.log(`${name}: ${middle}, off by ${distanceFound.toExponential(2)} of the diagonal${place(far)}, ` +
    `normals by ${turned.value.toFixed(3)} degrees${place(turned)}; the report says ${report?.max_error?.toExponential(2)}, ` +
    `${report?.normals.maximum.toFixed(3)} degrees`);
  checks.check(distanceFound <= POSITION_TOLERANCE, `${name}: positions are off by ${distanceFound} of the diagonal`);
  checks.check(turned.value <= turnAllowed, `${name}: normals are off by ${turned.value} degrees, allowed ${turnAllowed}`);
}

async function testRecipe(browser, recipeFile, folder) {
  const placed = placeRecipe(recipeFile, path.join(folder, 'recipe'));
  const report = bake(morphbake, placed, path.join(folder, 'baked'));
  const opened = openRecipe(placed);
  for (const output of opened.recipe.outputs ?? [{ file: `${opened.recipe.name}.glb` }]) {
    const name = path.basename(output.file);
    const reported = report.outputs.find((candidate) => path.basename(candidate.file) === name);
    checks.check(reported, `${name} is not in the report`);
    await compareOutput(browser, opened, output, reported, path.join(folder, 'baked', name));
  }
}

const browser = await openPage();
try {
  for (const file of files) await withFolder((folder) => testRecipe(browser, file, folder));
} catch (error) {
  checks.check(false, error.stack);
} finally {
  await browser.close();
}
checks.finish(`${files.length} recipes play in three.js as the reference says`);
