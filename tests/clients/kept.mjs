// Is everything of the source still in the output? The whole JSON, every accessor, every view and every image are compared.
// Usage: node kept.mjs SOURCE OUTPUT [NODE-INDEX]
import { pathToFileURL } from 'node:url';
import { readAccessor } from './reference/glb.mjs';
import { openPlain } from './reference/plain.mjs';

const FLOAT = 5126;
const STEPS = { 5120: 1.01 / 127, 5122: 1.01 / 32767 };  // of filtered normals and rotations
const PACKED = ['EXT_meshopt_compression', 'KHR_draco_mesh_compression'];

/**
 * What of the source the output lacks or has changed beyond what a bake in `shared` mode may change: the generator;
 * targets, names, weights and a clip at the end of their lists; zeros for the new targets in what weighs the old ones,
 * and zeros in old targets for attributes that the new ones have (clients want all targets alike);
 * buffers joined, images taken in, Draco and meshopt unpacked, wrong bounds put right.
 *
 * @param node        index of the node that morphs
 * @param startsThere false: the first shape is another than the source's, so its positions and normals may change
 * @param dropsSkin   true: the node is posed once and for all, so it has no skin any more
 * @param clips       how many animations were added
 * @return            differences in words, [] when everything is kept
 */
export async function findLost(sourceFile, outputFile, { node, startsThere = true, dropsSkin = false, clips = 1 }) {
  const [before, after] = [await openPlain(sourceFile), await openPlain(outputFile)];
  return compareDocuments(before, after, { node, startsThere, dropsSkin, clips });
}

/** The same for documents of openPlain(). */
export function compareDocuments(before, after, { node, startsThere = true, dropsSkin = false, clips = 1 }) {
  const lost = checkSelfContained(after);
  const dropped = new Set();
  if (dropsSkin) before = { ...before, json: withoutSkin(before.json, node, dropped) };
  const mesh = before.json.nodes[node].mesh;
  const left = structuredClone(after.json);
  const subject = { before: structuredClone(before.json), after: left, mesh, node, lost };
  const weighed = unpadWeights({ before, after }, subject);
  takeAddedClips(subject, clips);
  takeWeightSamplers(subject);
  takeAddedTargets(subject, after);
  const moved = startsThere ? new Set() : allowOtherStart(subject);
  const free = new Set([...weighed, ...moved, ...dropped]);
  takeTail(subject, { changed: free, dropped, unpacked: before.unpacked });
  takeRightBounds(subject.before, after, left, before.unpacked);
  const kept = { ...subject.before, images: takeImages(before, after, left, lost) };
  for (const json of [kept, left]) forgetAllowed(json);
  differences(kept, left, '', lost);
  if (lost.length > 0) return lost;  // values are compared where the JSON is alike
  compareAccessors(before, after, free, lost);
  if (before.unpacked.size === 0) compareViews(before, after, free, lost);
  compareImages(before, after, lost);
  return lost;
}

/**
 * The source's JSON without the skin of a node. Its mesh has nothing of joints any more; another node that has it keeps it,
 * and ours a copy.
 *
 * @param dropped  gets the accessors that nothing uses any more
 */
function withoutSkin(json, node, dropped) {
  const copy = structuredClone(json);
  const { skin, mesh } = copy.nodes[node];
  delete copy.nodes[node].skin;
  const has = (key, value) => copy.nodes.some((each, i) => i !== node && each.skin !== undefined && each[key] === value);
  if (has('mesh', mesh)) copy.nodes[node].mesh = copy.meshes.push(structuredClone(copy.meshes[mesh])) - 1;
  for (const { attributes } of copy.meshes[copy.nodes[node].mesh].primitives)
    for (const name of Object.keys(attributes)) if (/^(JOINTS|WEIGHTS)_/.test(name)) delete attributes[name];
  if (!has('skin', skin)) {
    copy.skins.splice(skin, 1);
    if (copy.skins.length === 0) delete copy.skins;
    for (const each of copy.nodes) if (each.skin > skin) each.skin--;
  }
  const used = usedAccessors(copy);
  for (const index of usedAccessors(json)) if (!used.has(index) && index !== undefined) dropped.add(index);
  return copy;
}

/** Lets whatever stands in the place of a part differ, or the place be gone. */
function takeAll(before, after, index) {
  if (after?.[index] !== undefined) after[index] = structuredClone(before[index]);
}

/** The output is one file without compression. */
function checkSelfContained({ written }) {
  const found = [];
  if ((written.buffers ?? []).length > 1) found.push('/buffers: more than one');
  for (const list of ['buffers', 'images'])
    (written[list] ?? []).forEach(({ uri }, i) => {
      if (uri !== undefined) found.push(`/${list}/${i}/uri: outside the file`);
    });
  const text = JSON.stringify(written);
  for (const name of PACKED) if (text.includes(`"${name}"`)) found.push(`${name} is still there`);
  return found;
}

/** Removes a list's elements after the first `count`; an emptied list that `before` has not goes. */
function cut(object, key, count, isKept) {
  if (object[key] === undefined) return [];
  const tail = object[key].splice(count);
  if (object[key].length === 0 && !isKept) delete object[key];
  return tail;
}

const targetCount = (json, mesh) => json.meshes?.[mesh]?.primitives?.[0]?.targets?.length ?? 0;

/** The channels of the source's animations that weigh the mesh's targets: {a, c, sampler}. */
const weightChannels = (json, mesh) => (json.animations ?? []).flatMap(({ channels }, a) =>
  channels.flatMap(({ sampler, target }, c) =>
    (isOfWeights(json, target, mesh) ? [{ a, c, sampler }] : [])));

function isOfWeights({ nodes }, { node, path, extensions }, mesh) {
  const [, list, index] = /^\/(nodes|meshes)\/(\d+)\/weights$/.exec(extensions?.KHR_animation_pointer?.pointer) ?? [];
  if (path === 'pointer') return list === 'meshes' ? Number(index) === mesh : nodes[Number(index)]?.mesh === mesh;
  return path === 'weights' && nodes[node]?.mesh === mesh;
}

/** Compares weights of the old targets in old animations. @return the accessors that nothing else reads */
function unpadWeights({ before, after }, { mesh, lost }) {
  const [old, all] = [before, after].map((plain) => targetCount(plain.json, mesh));
  const weights = weightChannels(before.json, mesh);
  for (const { a, c, sampler } of weights) {
    const { output } = before.json.animations[a].samplers[sampler];
    const { channels, samplers } = after.json.animations?.[a] ?? {};
    const now = samplers?.[channels?.[c]?.sampler]?.output;
    const at = `/animations/${a}/channels/${c}`;
    if (after.json.accessors?.[now] === undefined) lost.push(`${at}: has no output`);
    else comparePadded(readAccessor(before, output), readAccessor(after, now), old, all, at, lost);
  }
  const others = structuredClone(before.json);
  (others.animations ?? []).forEach((animation, a) => {
    animation.samplers = animation.samplers.map((sampler, s) => (isOfWeightsOnly(before.json, weights, a, s) ? {} : sampler));
  });
  const used = usedAccessors(others);
  const outputs = weights.map(({ a, sampler }) => before.json.animations[a].samplers[sampler].output);
  return new Set(outputs.filter((output) => !used.has(output)));
}

const isOfWeightsOnly = (json, weights, a, s) => json.animations[a].channels.every(({ sampler }, c) =>
  sampler !== s || weights.some((each) => each.a === a && each.c === c));

/** As float32, since weights of bytes may have become that. */
function comparePadded(was, is, old, all, at, lost) {
  if (is.length * old !== was.length * all)
    return lost.push(`${at}: ${is.length} weights of ${all} targets, were ${was.length} of ${old}`);
  for (let i = 0; i < is.length; i++) {
    const [row, k] = [Math.floor(i / all), i % all];
    const expected = k < old ? was[row * old + k] : 0;
    if (Math.fround(is[i]) !== Math.fround(expected))
      return lost.push(`${at}: weight ${k} of row ${row} is ${is[i]}, expected ${expected}`);
  }
}

/** Lets samplers of weights have another output, or be new ones where others read them too. */
function takeWeightSamplers({ before, after, mesh, lost }) {
  const weights = weightChannels(before, mesh);
  for (const { a, c, sampler } of weights) {
    const { channels, samplers } = after.animations?.[a] ?? {};
    const [was, is] = [before.animations[a].samplers[sampler], samplers?.[channels?.[c]?.sampler]];
    if (is === null || typeof is !== 'object') continue;
    if (channels[c].sampler !== sampler && channels[c].sampler >= before.animations[a].samplers.length) {
      differences({ ...was, output: 0 }, { ...is, output: 0 }, `/animations/${a}/samplers/${channels[c].sampler}`, lost);
      channels[c].sampler = sampler;
    } else if (isOfWeightsOnly(before, weights, a, sampler)) takeOver(was, is, ['output']);
  }
  for (const { a } of weights)
    if (after.animations?.[a]) cut(after.animations[a], 'samplers', before.animations[a].samplers.length, true);
}

function takeAddedClips({ before, after, node, lost }, clips) {
  const count = before.animations?.length ?? 0;
  const added = cut(after, 'animations', count, before.animations);
  if (added.length !== clips) lost.push(`/animations: ${added.length} added, expected ${clips}`);
  for (const { channels } of added)
    for (const { target } of channels)
      if (target.node !== node || target.path !== 'weights')
        lost.push(`the new animation moves ${target.path} of node ${target.node}`);
}

/** Cuts what was added to the mesh and to the nodes that show it. */
function takeAddedTargets({ before, after, mesh, lost }, plain) {
  const [was, is] = [before.meshes[mesh], after.meshes?.[mesh]];
  if (!is) return;
  const old = targetCount(before, mesh);
  const added = (is.primitives ?? []).map((primitive) => cut(primitive, 'targets', old, old > 0).length);
  was.primitives.forEach(({ targets = [] }, p) => targets.forEach((target, k) =>
    takeZeros(target, is.primitives?.[p]?.targets?.[k], plain)));
  if (new Set(added).size > 1) lost.push(`/meshes/${mesh}: primitives got ${added} targets`);
  const all = old + (added[0] ?? 0);
  const weights = cut(is, 'weights', old, was.weights);
  if (all > 0 && weights.length !== all - old) lost.push(`/meshes/${mesh}/weights: ${weights.length} added, expected ${all - old}`);
  if (!was.weights && is.weights?.every((w) => w === 0)) delete is.weights;
  if (all > old) takeAddedNames(was, is, old, all, `/meshes/${mesh}`, lost);
  before.nodes.forEach((node, i) => {
    if (node.mesh !== mesh || !after.nodes?.[i]) return;
    const tail = cut(after.nodes[i], 'weights', old, node.weights);
    if (tail.some((w) => w !== 0) || (node.weights && tail.length !== all - old))
      lost.push(`/nodes/${i}/weights: ${tail} added`);
  });
}

function takeZeros(before, after, plain) {
  for (const [name, index] of Object.entries(after ?? {}))
    if (!Object.hasOwn(before, name) && plain.json.accessors[index] && readAccessor(plain, index).every((x) => x === 0)) delete after[name];
}

function takeAddedNames(was, is, old, all, at, lost) {
  const names = is.extras?.targetNames;
  if (names?.length !== all) return lost.push(`${at}/extras/targetNames: ${names?.length} names, expected ${all}`);
  cut(is.extras, 'targetNames', was.extras?.targetNames?.length ?? 0, was.extras?.targetNames);
  if (was.extras === undefined && Object.keys(is.extras).length === 0) delete is.extras;
}

/** Lets the morphed primitives have other positions and normals. @return accessors that nothing else uses */
function allowOtherStart({ before, after, mesh }) {
  const free = new Set();
  const attributes = ['POSITION', 'NORMAL', 'TANGENT'];
  before.meshes[mesh].primitives.forEach((primitive, p) => {
    const is = after.meshes?.[mesh]?.primitives?.[p];
    for (const name of attributes) {
      if (primitive.attributes[name] === undefined) continue;
      if (is?.attributes[name] !== undefined) is.attributes[name] = primitive.attributes[name];
      free.add(primitive.attributes[name]);
    }
    if (primitive.attributes.NORMAL === undefined) delete is?.attributes.NORMAL;
  });
  const others = structuredClone(before);
  for (const primitive of others.meshes[mesh].primitives) for (const name of attributes) delete primitive.attributes[name];
  for (const used of usedAccessors(others)) free.delete(used);
  return free;
}

function usedAccessors({ meshes = [], animations = [], skins = [] }) {
  const primitives = meshes.flatMap((mesh) => mesh.primitives);
  return new Set([
    ...primitives.flatMap(({ attributes, indices, targets = [] }) =>
      [indices, ...[attributes, ...targets].flatMap(Object.values)]),
    ...animations.flatMap(({ samplers }) => samplers.flatMap(({ input, output }) => [input, output])),
    ...skins.map(({ inverseBindMatrices }) => inverseBindMatrices),
  ]);
}

/** Cuts accessors and views after the source's, and lets `changed` accessors differ; those of `dropped` may be any. */
function takeTail({ before, after }, { changed, dropped, unpacked }) {
  cut(after, 'accessors', before.accessors?.length ?? 0, before.accessors);
  cut(after, 'bufferViews', before.bufferViews?.length ?? 0, before.bufferViews);
  for (const i of changed) {
    takeViews(before, after, i, { changed, dropped });
    if (dropped.has(i)) takeAll(before.accessors, after.accessors, i);
    else takeOver(before.accessors[i], after.accessors?.[i],
      ['bufferView', 'byteOffset', 'componentType', 'normalized', 'count', 'min', 'max', 'sparse']);
  }
  if (unpacked.size === 0) return;
  // Draco's own views are gone, so the others may have moved up: accessors are compared by value, views not at all.
  for (const json of [before, after]) {
    delete json.bufferViews;
    json.accessors.forEach((accessor, i) => {
      if (accessor.bufferView !== undefined) accessor.bufferView = 'some view';
      if (unpacked.has(i)) delete accessor.byteOffset;
    });
  }
}

const viewsOf = ({ bufferView, sparse }) =>
  [bufferView, sparse?.indices.bufferView, sparse?.values.bufferView].filter((view) => view !== undefined);

/** Lets views that only changed accessors have differ: the own one in its size, those of sparse in all. */
function takeViews(before, after, index, { changed, dropped }) {
  const accessor = before.accessors[index];
  for (const view of viewsOf(accessor)) {
    if (!isOnlyOf(before, view, changed)) continue;
    if (view !== accessor.bufferView || dropped.has(index)) takeAll(before.bufferViews, after.bufferViews, view);
    else takeOver(before.bufferViews[view], after.bufferViews?.[view], ['byteLength', 'byteStride', 'target']);
  }
}

/** Writes fields of `from` over those of `to`, where `to` is an object. */
function takeOver(from, to, keys) {
  if (to === null || typeof to !== 'object') return;
  for (const key of keys) {
    delete to[key];
    if (from[key] !== undefined) to[key] = from[key];
  }
}

const isOnlyOf = (json, view, accessors) =>
  json.accessors.every((accessor, i) => !viewsOf(accessor).includes(view) || accessors.has(i));

/** Lets bounds that the source tells wrongly be right, or those that came out of Draco be gone. */
function takeRightBounds(before, after, left, unpacked) {
  (before.accessors ?? []).forEach((accessor, i) => {
    const is = left.accessors?.[i];
    // Draco reorders vertices: what indices were bound by says nothing any more.
    if (unpacked.has(i) && is && !is.min && !is.max) return takeOver(accessor, is, ['min', 'max']);
    if (!is?.min || !is.max || JSON.stringify([accessor.min, accessor.max]) === JSON.stringify([is.min, is.max])) return;
    const raw = { ...after.json, accessors: after.json.accessors.map((each) => ({ ...each, normalized: false })) };
    const values = readAccessor({ ...after, json: raw }, i);
    const isRight = is.min.length * is.count === values.length && is.min.every((low, k) => {
      const column = values.filter((_, at) => at % is.min.length === k);
      const round = is.componentType === FLOAT ? Math.fround : (x) => x;
      return round(low) === Math.min(...column) && round(is.max[k]) === Math.max(...column);
    });
    if (isRight) takeOver(accessor, is, ['min', 'max']);
  });
}

/** Images without where they lie. @return those of the source; the output's are changed in `left` */
function takeImages(before, after, left, lost) {
  const outside = (i) => before.written.images[i].uri !== undefined;
  (left.images ?? []).forEach((image, i) => {
    if (!before.written.images?.[i]) return;
    if (outside(i) || before.unpacked.size > 0) delete image.bufferView;
    if (outside(i) && before.written.images[i].mimeType === undefined) {
      if (image.mimeType !== sniffType(after.images[i])) lost.push(`/images/${i}/mimeType: ${image.mimeType}`);
      delete image.mimeType;
    }
  });
  return before.json.images?.map(({ bufferView, ...image }) =>
    ({ ...image, ...(bufferView !== undefined && before.unpacked.size === 0 && { bufferView }) }));
}

const sniffType = (bytes) => (bytes?.[0] === 0x89 ? 'image/png' : 'image/jpeg');

function forgetAllowed(json) {
  delete json.buffers;
  for (const key of Object.keys(json)) if (json[key] === undefined) delete json[key];
  json.asset = { ...json.asset, generator: undefined };
  delete json.asset.generator;
  json.bufferViews = json.bufferViews?.map(({ buffer, byteOffset, ...view }) => view);
  if (json.bufferViews === undefined) delete json.bufferViews;
}

const kindOf = (value) => (Array.isArray(value) ? 'array' : value === null ? 'null' : typeof value);
const show = (value) => (value === undefined ? 'nothing' : JSON.stringify(value).slice(0, 80));

/** Every place at which two JSON values differ. */
function differences(before, after, at, lost) {
  const kind = kindOf(before);
  if (kind !== kindOf(after) || !['array', 'object'].includes(kind)) {
    if (before !== after) lost.push(`${at}: ${show(after)}, was ${show(before)}`);
    return;
  }
  for (const key of new Set([...Object.keys(before), ...Object.keys(after)])) {
    const place = `${at}/${key.replaceAll('~', '~0').replaceAll('/', '~1')}`;
    if (!Object.hasOwn(before, key)) lost.push(`${place}: ${show(after[key])} is new`);
    else if (!Object.hasOwn(after, key)) lost.push(`${place}: ${show(before[key])} is gone`);
    else differences(before[key], after[key], place, lost);
  }
}

function compareAccessors(before, after, changed, lost) {
  (before.json.accessors ?? []).forEach((accessor, i) => {
    if (changed.has(i) || !after.json.accessors?.[i]) return;
    const [was, is] = [readAccessor(before, i), readAccessor(after, i)];
    const slack = before.filtered.has(accessor.bufferView) ? STEPS[accessor.componentType] ?? 0 : 0;
    const isSame = (value, k) => value === is[k] || Math.abs(value - is[k]) <= slack || (Number.isNaN(value) && Number.isNaN(is[k]));
    const first = was.findIndex((value, k) => !isSame(value, k));
    if (was.length !== is.length || first >= 0)
      lost.push(`/accessors/${i}: value ${first} is ${is[first]}, was ${was[first]}`);
  });
}

function viewBytes({ json, bin }, i) {
  const { byteOffset = 0, byteLength } = json.bufferViews[i];
  return Buffer.from(bin.buffer, bin.byteOffset + byteOffset, byteLength);
}

function compareViews(before, after, changed, lost) {
  (before.json.bufferViews ?? []).forEach((_, i) => {
    const isFree = isOnlyOf(before.json, i, changed) &&
      [...changed].some((accessor) => viewsOf(before.json.accessors[accessor]).includes(i));
    if (isFree || before.filtered.has(i) || !after.json.bufferViews?.[i]) return;
    if (!viewBytes(before, i).equals(viewBytes(after, i))) lost.push(`/bufferViews/${i}: other bytes`);
  });
}

function compareImages(before, after, lost) {
  before.images.forEach((bytes, i) => {
    if (!after.images[i] || !Buffer.from(bytes).equals(Buffer.from(after.images[i]))) lost.push(`/images/${i}: other bytes`);
  });
}

if (import.meta.url === pathToFileURL(process.argv[1] ?? '').href) {
  const [source, output, node = '0'] = process.argv.slice(2);
  const lost = await findLost(source, output, { node: Number(node) });
  console.log(lost.length ? lost.join('\n') : 'everything is kept');
  process.exit(lost.length ? 1 : 0);
}
