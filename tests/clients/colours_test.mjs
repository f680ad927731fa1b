// Colours of sources morph: COLOR_0 and its targets show the mix of the sources' colours that the shape is a mix of.
// Usage: node colours_test.mjs --morphbake PROGRAM
import { readFileSync, writeFileSync } from 'node:fs';
import path from 'node:path';
import { parseGlb, readAccessor } from './reference/glb.mjs';
import { sampleAt } from './reference/scene.mjs';
import { makeShape } from './shapes/make_shapes.mjs';
import { packChunks } from './shapes/write_glb.mjs';
import { bake, readArguments, startChecks, withFolder } from './support.mjs';

const { morphbake } = readArguments('morphbake');
const checks = startChecks();
const PAINTS = { orb: [0.8, 0.1, 0.2], 'orb-long': [0.1, 0.6, 0.9] };

/** Gives a shape's material a colour. */
function paint(folder, name) {
  makeShape(`${name}.glb`, folder);
  const file = path.join(folder, `${name}.glb`);
  const bytes = readFileSync(file);
  const { json, bin } = parseGlb(bytes);
  json.materials = [{ pbrMetallicRoughness: { baseColorFactor: [...PAINTS[name], 1], metallicFactor: 0 } }];
  for (const primitive of json.meshes[0].primitives) primitive.material = 0;
  writeFileSync(file, packChunks(json, bin));
}

/** Colours of all vertices at a time, times the material's factor. */
function coloursAt(glb, time) {
  const [{ samplers, channels }] = glb.json.animations;
  const sampler = samplers[channels[0].sampler];
  const [{ attributes, targets, material }] = glb.json.meshes[0].primitives;
  const weights = sampleAt(glb, sampler, 'weights', time);
  const factor = glb.json.materials[material].pbrMetallicRoughness.baseColorFactor;
  const rows = Float64Array.from(readAccessor(glb, attributes.COLOR_0));
  targets.forEach((target, k) => {
    readAccessor(glb, target.COLOR_0).forEach((x, i) => { rows[i] += weights[k] * x; });
  });
  return rows.map((x, i) => x * factor[i % 3]);
}

await withFolder((folder) => {
  for (const name of Object.keys(PAINTS)) paint(folder, name);
  const file = path.join(folder, 'recipe.json');
  const sources = { orb: 'orb.glb', long: 'orb-long.glb' };
  const kinds = ['tracks', 'keyframes', 'basis', 'frames'];
  writeFileSync(file, JSON.stringify({ version: 1, name: 'painted', sources, connectivity: { mode: 'resample', max_vertices: 2000 }, hold: 'none',
    timeline: { fps: 10, tracks: [{ name: 'long', to: 'long', begin: 0, end: 1, ease: 'linear' }] },
    outputs: [...kinds.map((targets) => ({ file: `${targets}.glb`, targets })), { file: 'still.glb', still: { at: 0.5 } }] }));
  bake(morphbake, file, path.join(folder, 'out'));
  for (const kind of kinds) {
    const glb = parseGlb(readFileSync(path.join(folder, 'out', `${kind}.glb`)));
    for (const time of [0, 0.25, 0.5, 1]) {
      const expected = PAINTS.orb.map((x, axis) => (1 - time) * x + time * PAINTS['orb-long'][axis]);
      const off = coloursAt(glb, time).reduce((most, x, i) => Math.max(most, Math.abs(x - expected[i % 3])), 0);
      checks.check(off < 1e-5, `${kind}: colours are ${off} off at ${time} s`);
    }
  }
  const { json, ...rest } = parseGlb(readFileSync(path.join(folder, 'out', 'still.glb')));
  const colours = readAccessor({ json, ...rest }, json.meshes[0].primitives[0].attributes.COLOR_0);
  const off = colours.reduce((most, x, i) => Math.max(most, Math.abs(x - (PAINTS.orb[i % 3] + PAINTS['orb-long'][i % 3]) / 2)), 0);
  checks.check(off < 1e-5, `the still's colours are ${off} off`);
});
checks.finish('colours morph');
