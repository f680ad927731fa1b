// What importers trip over (design.md, section 13), checked on a file's raw JSON and numbers.
// Usage: node structure_test.mjs FILE_OR_FOLDER...
import { readFileSync } from 'node:fs';
import { parseGlb, readAccessor, readTriangles } from './reference/glb.mjs';
import { findGlbs, readArguments, startChecks } from './support.mjs';

const FLOAT = 5126;
const MOST_TARGETS = 255;
const LONGEST_NAME = 63;  // bytes: Blender cuts the rest off

const { files: names } = readArguments();
const checks = startChecks();
const same = (a, b) => a.length === b.length && a.every((value, i) => value === b[i]);

function checkAccessors(glb, check) {
  (glb.json.accessors ?? []).forEach((accessor, index) => {
    const at = `/accessors/${index}`;
    // Legal (all zeros), but several clients read garbage.
    check(accessor.bufferView !== undefined || accessor.sparse, `${at} has neither bufferView nor sparse`);
    const values = readAccessor(glb, index);
    check(values.every(Number.isFinite), `${at} has values that are not finite`);
    if (accessor.min || accessor.max) checkBounds(accessor, values, check, at);
  });
}

function checkBounds({ min, max, componentType, normalized }, values, check, at) {
  if (!check(min && max, `${at} has one of min and max`) || normalized) return;
  const round = componentType === FLOAT ? Math.fround : (x) => x;
  min.forEach((written, k) => {
    const column = values.filter((_, i) => i % min.length === k);
    const [low, high] = column.reduce(([a, b], x) => [Math.min(a, x), Math.max(b, x)], [Infinity, -Infinity]);
    check(round(written) === low && round(max[k]) === high, `${at} bounds ${written}..${max[k]}, its values ${low}..${high}`);
  });
}

function checkPrimitive(glb, primitive, check, at) {
  const { accessors } = glb.json;
  const count = accessors[primitive.attributes.POSITION].count;
  const used = new Set(readTriangles(glb, primitive));
  check(used.size === count, `${at} uses ${used.size} of ${count} vertices`);
  const positions = [primitive.attributes, ...(primitive.targets ?? [])].map((attributes) => attributes.POSITION);
  for (const index of positions) check(index !== undefined && accessors[index].min, `${at} has a POSITION without bounds`);
  for (const attributes of [primitive.attributes, ...(primitive.targets ?? [])])
    for (const [name, index] of Object.entries(attributes))
      check(accessors[index].count === count, `${at} ${name} has ${accessors[index].count} elements, expected ${count}`);
}

/** All targets of all primitives of a mesh have one attribute set, and good names. */
function checkTargets(mesh, check, at) {
  const counts = mesh.primitives.map(({ targets = [] }) => targets.length);
  check(counts.every((count) => count === counts[0]), `${at} has primitives with ${counts} targets`);
  const sets = mesh.primitives.flatMap(({ targets = [] }) => targets.map((target) => Object.keys(target).sort().join()));
  check(new Set(sets).size <= 1, `${at} has targets with different attributes: ${[...new Set(sets)].join(' | ')}`);
  if (counts[0] > MOST_TARGETS) console.log(`warning: ${at} has ${counts[0]} targets; many clients stop at ${MOST_TARGETS}`);
  const targetNames = mesh.extras?.targetNames ?? [];
  check(targetNames.length === counts[0], `${at} has ${targetNames.length} target names, expected ${counts[0]}`);
  check(new Set(targetNames).size === targetNames.length, `${at} has a target name twice`);
  for (const name of targetNames) {
    const bytes = typeof name === 'string' ? Buffer.byteLength(name) : 0;
    check(bytes > 0 && bytes <= LONGEST_NAME && !name.includes(':'), `${at} has the target name ${JSON.stringify(name)}`);
  }
  if (counts[0]) check(mesh.weights?.length === counts[0], `${at} has ${mesh.weights?.length} weights, expected ${counts[0]}`);
}

function checkWeightsChannel(glb, animation, channel, check, at) {
  const { accessors, nodes, meshes } = glb.json;
  const sampler = animation.samplers[channel.sampler];
  const output = accessors[sampler.output];
  check((sampler.interpolation ?? 'LINEAR') === 'LINEAR', `${at} is ${sampler.interpolation}`);
  check(output.componentType === FLOAT && !output.sparse, `${at} weights are sparse or not float32`);
  const times = readAccessor(glb, sampler.input);
  check(times[0] === 0, `${at} begins at ${times[0]} s`);
  check(times.every((t, i) => i === 0 || t > times[i - 1]), `${at} has times that do not rise`);
  const weights = readAccessor(glb, sampler.output);
  check(weights.every((w) => w >= 0 && w <= 1), `${at} has weights outside 0..1`);
  const mesh = meshes[nodes[channel.target.node].mesh];
  const count = mesh.primitives[0].targets?.length ?? 0;
  check(weights.length === times.length * count, `${at} has ${weights.length} weights, expected ${times.length} x ${count}`);
  const row = (i) => [...weights.subarray(i * count, (i + 1) * count)];
  check(same((mesh.weights ?? []).map(Math.fround), row(0)), `${at}: mesh.weights ${mesh.weights} is not the first key ${row(0)}`);
  const loops = same(row(0), row(times.length - 1));
  console.log(`  ${times.length} keys to ${times.at(-1)} s, ${count} targets, ${loops ? 'loops' : 'does not return to its first pose'}`);
}

function checkFile(file) {
  console.log(file);
  const check = (holds, message) => checks.check(holds, `${file}: ${message}`);
  const glb = parseGlb(readFileSync(file));
  checkAccessors(glb, check);
  (glb.json.meshes ?? []).forEach((mesh, m) => {
    checkTargets(mesh, check, `/meshes/${m}`);
    mesh.primitives.forEach((primitive, p) => checkPrimitive(glb, primitive, check, `/meshes/${m}/primitives/${p}`));
  });
  (glb.json.animations ?? []).forEach((animation, a) => {
    for (const [c, channel] of animation.channels.entries())
      if (channel.target.path === 'weights') checkWeightsChannel(glb, animation, channel, check, `/animations/${a}/channels/${c}`);
  });
}

const files = findGlbs(names);
checks.check(files.length > 0, 'there is no file to check');
for (const file of files) checkFile(file);
checks.finish(`${files.length} files have no known trap`);
