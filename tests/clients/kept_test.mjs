// The comparison of kept.mjs itself: a bake by hand passes, and whatever of it is taken away or changed is found.
// Usage: node kept_test.mjs
import { writeFileSync } from 'node:fs';
import path from 'node:path';
import { FLOAT, putAccessor, putNumbers, putPoints, putTimes, putView, toGlb } from './forms/document.mjs';
import { writeForm } from './forms/forms.mjs';
import { compareDocuments, findLost } from './kept.mjs';
import { readAccessor } from './reference/glb.mjs';
import { openPlain } from './reference/plain.mjs';
import { startChecks, withFolder } from './support.mjs';

const checks = startChecks();

/** What a bake must do to a source, done plainly: one target more, and a clip. */
function bakeByHand(plain, node) {
  const json = structuredClone(plain.json);
  const document = { json, chunks: [Buffer.from(plain.bin)], length: plain.bin.length };
  delete json.buffers;
  plain.images.forEach((bytes, i) => {
    if (json.images[i].bufferView !== undefined) return;
    Object.assign(json.images[i], { bufferView: putView(document, bytes), mimeType: 'image/png' });
  });
  const mesh = json.meshes[json.nodes[node].mesh];
  const old = mesh.primitives[0].targets?.length ?? 0;
  padWeights(document, plain, json.nodes[node].mesh, old);
  for (const primitive of mesh.primitives) addTarget(document, primitive);
  mesh.weights = [...(mesh.weights ?? new Array(old).fill(0)), 0];
  const names = mesh.extras?.targetNames ?? Array.from({ length: old }, (_, i) => `${i}`);
  mesh.extras = { ...mesh.extras, targetNames: [...names, 'added'] };
  for (const each of json.nodes) if (each.mesh === json.nodes[node].mesh) each.weights?.push(0);
  const row = (w) => [...new Array(old).fill(0), w];
  json.animations = [...(json.animations ?? []), { name: 'baked',
    channels: [{ sampler: 0, target: { node, path: 'weights' } }],
    samplers: [{ input: putTimes(document, [0, 1]), output: putNumbers(document, [...row(0), ...row(1)]) }] }];
  json.asset.generator = 'a hand';
  return toGlb(document);
}

function addTarget(document, primitive) {
  const { count } = document.json.accessors[primitive.attributes.POSITION];
  const rows = (row) => putPoints(document, Array.from({ length: count }, () => row));
  for (const target of primitive.targets ?? []) target.NORMAL ??= rows([0, 0, 0]);
  primitive.targets = [...(primitive.targets ?? []), { POSITION: rows([1, 0, 0]), NORMAL: rows([0, 0, 1]) }];
}

/** In place where only the mesh's channels read the weights, else by a sampler of their own. */
function padWeights(document, plain, mesh, old) {
  for (const { channels, samplers } of document.json.animations ?? []) {
    const isOurs = ({ target }) => target.path === 'weights' && plain.json.nodes[target.node].mesh === mesh;
    for (const sampler of new Set(channels.filter(isOurs).map((channel) => channel.sampler))) {
      const { output } = samplers[sampler];
      const rows = readAccessor(plain, output);
      const padded = Array.from({ length: rows.length / old }, (_, i) => [...rows.subarray(i * old, (i + 1) * old), 0]).flat();
      const index = putAccessor(document, padded.map((w) => [w]), FLOAT);
      const readers = channels.filter((channel) => channel.sampler === sampler);
      if (readers.every(isOurs)) document.json.accessors[output] = document.json.accessors.pop();
      else for (const channel of readers.filter(isOurs)) channel.sampler = samplers.push({ ...samplers[sampler], output: index }) - 1;
    }
  }
}

/** Every place in a JSON value, as a list of keys. */
function placesOf(value, at = []) {
  if (value === null || typeof value !== 'object') return [];
  return Object.keys(value).flatMap((key) => [[...at, key], ...placesOf(value[key], [...at, key])]);
}

function otherThan(value) {
  if (typeof value === 'number') return Math.abs(value) < 1e15 ? value + 1 : value / 2;
  if (typeof value === 'string') return `${value}x`;
  return typeof value === 'boolean' ? !value : 'another';
}

/** What may differ, or does not count: where bytes lie, weights that are no longer bytes, and who wrote the file. */
const isFree = ([a, b, c], before, after) => a === 'buffers' || (a === 'asset' && b === 'generator') ||
  (a === 'bufferViews' && (before.unpacked.size > 0 || ['buffer', 'byteOffset', 'byteLength'].includes(c))) ||
  (a === 'accessors' && before.unpacked.has(Number(b)) && c === 'bufferView') ||
  (a === 'accessors' && c === 'normalized' &&
    before.json.accessors[b].componentType !== after.json.accessors[b].componentType) ||
  (a === 'images' && before.unpacked.size > 0 && c === 'bufferView');

function isFound(before, after, node) {
  try {
    return compareDocuments(before, after, { node }).length > 0;
  } catch {
    return true;  // a file that cannot be read any more
  }
}

function withChange(after, change) {
  const changed = { ...after, json: structuredClone(after.json) };
  change(changed.json);
  return { ...changed, written: changed.json };
}

function tryPlaces(name, before, after, node) {
  let tried = 0;
  for (const place of placesOf(before.json).filter((each) => !isFree(each, before, after))) {
    const keys = place.slice(0, -1);
    const key = place.at(-1);
    const parentOf = (json) => keys.reduce((value, step) => value[step], json);
    const changes = { changed: (json) => { parentOf(json)[key] = otherThan(parentOf(json)[key]); },
      removed: (json) => { if (Array.isArray(parentOf(json))) parentOf(json).splice(key, 1); else delete parentOf(json)[key]; },
      extended: (json) => { parentOf(json)[`${key}-more`] = 1; } };
    if (Array.isArray(parentOf(after.json))) delete changes.extended;
    for (const [what, change] of Object.entries(changes)) {
      tried++;
      checks.check(isFound(before, withChange(after, change), node), `${name}: /${place.join('/')} ${what}: not found`);
    }
  }
  return tried;
}

/** One bit of every accessor and every image. */
function tryBytes(name, before, after, node) {
  for (const [i, { bufferView, byteOffset = 0 }] of after.json.accessors.entries()) {
    if (i >= before.json.accessors.length || bufferView === undefined) continue;
    const changed = { ...after, bin: Uint8Array.from(after.bin) };
    changed.bin[after.json.bufferViews[bufferView].byteOffset + byteOffset] ^= 4;
    checks.check(isFound(before, changed, node), `${name}: a bit of accessor ${i}: not found`);
  }
  for (const i of before.images.keys()) {
    const changed = { ...after, images: after.images.map((bytes) => Uint8Array.from(bytes)) };
    changed.images[i][40] ^= 1;
    checks.check(isFound(before, changed, node), `${name}: a bit of image ${i}: not found`);
  }
}

const ADDED = {
  'a weight that is not zero': (json, plain) => {
    const { bufferView } = json.accessors[json.animations[0].samplers[0].output];
    plain.bin[json.bufferViews[bufferView].byteOffset + 10] = 0x40;
  },
  'a clip that moves a node': (json) => { json.animations.at(-1).channels[0].target.path = 'translation'; },
  'no clip': (json) => { json.animations.pop(); },
  'an old target gone': (json) => { json.meshes[0].primitives[0].targets.shift(); },
  'the new target first': (json) => { json.meshes[0].primitives[0].targets.unshift(json.meshes[0].primitives[0].targets.pop()); },
  'the new name first': (json) => { json.meshes[0].extras.targetNames.unshift(json.meshes[0].extras.targetNames.pop()); },
  'normals in an old target': (json) => { const [old, added] = json.meshes[0].primitives[0].targets.slice(-2); old.NORMAL = added.NORMAL; },
  'a name too few': (json) => { json.meshes[0].extras.targetNames.pop(); },
  'a weight too few': (json) => { json.meshes[0].weights.pop(); },
  'weights of a node that were not padded': (json) => { json.nodes[0].weights.pop(); },
  'another node': (json) => { json.nodes.push({ name: 'more' }); },
  'another extension': (json) => { json.extensionsUsed = ['KHR_materials_unlit']; },
  'a file outside': (json) => { json.buffers[0].uri = 'more.bin'; },
};

function tryAdditions(before, after, node) {
  for (const [name, change] of Object.entries(ADDED)) {
    const copy = { ...after, bin: Uint8Array.from(after.bin) };
    const changed = { ...withChange(copy, (json) => change(json, copy)), bin: copy.bin };
    checks.check(isFound(before, changed, node), `${name}: not found`);
  }
}

let tried = 0;
const SOURCES = { 'unknown': 0, 'targets-cubic': 0, 'targets-instanced': 0, 'targets-shared-sampler': 1,
  'skin': 0, 'cameras-lights': 0, 'several-by-node': 1, 'instanced': 1,
  'external': 0, 'data-uris': 0, 'draco': 0, 'draco-beside-plain': 0, 'meshopt': 0, 'sparse': 0 };
for (const [name, node] of Object.entries(SOURCES))
  await withFolder(async (folder) => {
    const { a: source } = await writeForm(name, folder);
    const before = await openPlain(source);
    const output = path.join(folder, 'out.glb');
    writeFileSync(output, bakeByHand(before, node));
    const lost = await findLost(source, output, { node });
    if (!checks.check(lost.length === 0, `${name}: kept by hand, but: ${lost.join('\n')}`)) return;
    const after = await openPlain(output);
    tried += tryPlaces(name, before, after, node);
    tryBytes(name, before, after, node);
    if (name === 'targets-cubic') tryAdditions(before, after, node);
  });
checks.finish(`${Object.keys(SOURCES).length} files kept by hand; each of ${tried} changes is found`);
