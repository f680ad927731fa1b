// Bakes one recipe of each kind and compares the shapes that the file shows with those that stand beside this script.
// Usage: node golden_test.mjs --morphbake PROGRAM [KIND...]
//        node golden_test.mjs --morphbake PROGRAM --update [KIND...]    writes them anew: look at the difference
import { existsSync, mkdirSync, readFileSync, writeFileSync } from 'node:fs';
import path from 'node:path';
import { fileURLToPath } from 'node:url';
import { parseArgs } from 'node:util';
import { parseGlb, readAccessor } from '../clients/reference/glb.mjs';
import { bake, placeRecipe, startChecks, withFolder } from '../clients/support.mjs';
import { FILES, RECIPES } from './recipes.mjs';

const HERE = path.join(path.dirname(fileURLToPath(import.meta.url)), 'shapes');
const SAMPLES = 16; // vertices of a primitive
const DIGITS = 6;
const TOLERANCE = 2e-6; // the shapes are about 2 wide: rounding here and in the file's floats
const MOMENTS = [0, 0.25, 0.5, 0.75, 1];

/** Weights of the only animation at a time, by LINEAR interpolation. */
function weightsAt(glb, time) {
  const { channels, samplers } = glb.json.animations[0];
  const sampler = samplers[channels.find(({ target }) => target.path === 'weights').sampler];
  const times = readAccessor(glb, sampler.input), values = readAccessor(glb, sampler.output);
  const count = values.length / times.length;
  const next = Math.min(Math.max(times.findIndex((t) => t >= time), 1), times.length - 1);
  const share = times.length === 1 ? 0 : Math.min(Math.max((time - times[next - 1]) / (times[next] - times[next - 1]), 0), 1);
  return Array.from({ length: count }, (_, k) => (1 - share) * values[(next - 1) * count + k] + share * values[next * count + k]);
}

/** Positions of some vertices of each primitive at a time. */
function samplesAt(glb, time) {
  const weights = weightsAt(glb, time);
  return glb.json.meshes[0].primitives.map(({ attributes, targets }) => {
    const base = readAccessor(glb, attributes.POSITION);
    const moves = targets.map((target) => readAccessor(glb, target.POSITION));
    const vertices = base.length / 3;
    return Array.from({ length: SAMPLES }, (_, i) => Math.floor((i * vertices) / SAMPLES)).map((v) =>
      [0, 1, 2].map((axis) => base[3 * v + axis] + moves.reduce((sum, move, k) => sum + weights[k] * move[3 * v + axis], 0)));
  });
}

function farthest(found, expected) {
  const a = found.flat(Infinity), b = expected.flat(Infinity);
  return a.length === b.length ? Math.max(...a.map((x, i) => Math.abs(x - b[i]))) : Infinity;
}

async function shapesOf(program, kind) {
  return withFolder((folder) => {
    const file = path.join(folder, 'recipe.json');
    const files = Object.fromEntries(Object.entries(RECIPES[kind].sources).filter(([, source]) => typeof source === 'string'));
    // Derived sources have no file to place.
    writeFileSync(file, JSON.stringify({ ...RECIPES[kind], sources: files }));
    const placed = placeRecipe(file, path.join(folder, 'placed'));
    writeFileSync(placed, JSON.stringify(RECIPES[kind]));
    for (const [name, bytes] of Object.entries(FILES)) writeFileSync(path.join(folder, 'placed', name), bytes);
    bake(program, placed, path.join(folder, 'out'));
    const glb = parseGlb(readFileSync(path.join(folder, 'out', 'golden.glb')));
    return MOMENTS.map((time) => ({ time, primitives: samplesAt(glb, time) }));
  });
}

const { values, positionals } = parseArgs({ allowPositionals: true,
  options: { morphbake: { type: 'string' }, update: { type: 'boolean', default: false } } });
const checks = startChecks();
const kinds = positionals.length ? positionals : Object.keys(RECIPES);
for (const kind of kinds) {
  const file = path.join(HERE, `${kind}.json`);
  const shapes = await shapesOf(values.morphbake, kind);
  if (values.update) {
    mkdirSync(HERE, { recursive: true });
    const rows = shapes.map(({ time, primitives }) =>
      `{"time": ${time}, "primitives": ${JSON.stringify(primitives.map((points) => points.map((p) => p.map((x) => Number(x.toFixed(DIGITS))))))}}`);
    writeFileSync(file, `[\n${rows.join(',\n')}\n]\n`);
    continue;
  }
  if (!checks.check(existsSync(file), `${kind}: no golden shapes; run with --update and look at them`)) continue;
  const golden = JSON.parse(readFileSync(file, 'utf8'));
  golden.forEach(({ time, primitives }, k) => {
    const off = farthest(shapes[k].primitives, primitives);
    checks.check(off <= TOLERANCE, `${kind} at ${time} s: off by ${off}`);
  });
}
checks.finish(`${kinds.length} kinds`);
