// Small legal files, one for each form in which glTF may hold a surface, each as shape 'a' and shape 'b'.
// Usage: node forms.mjs FOLDER    writes all of them
import { mkdirSync, writeFileSync } from 'node:fs';
import path from 'node:path';
import { pathToFileURL } from 'node:url';
import { cross, unit } from '../reference/vectors.mjs';
import * as gltf from './document.mjs';
import { putDraco, putMeshopt } from './packed.mjs';
import { drawChecks, drawWebp } from './pictures.mjs';
import { COLUMNS, disc, pieceOf, ring, ringStrip, unshared } from './surfaces.mjs';

const SUBJECT = { name: 'subject', mesh: 0 };
const TURN = [0.18257418583505536, 0.3651483716701107, 0.5477225575051661, 0.7302967433402214];

/** A document of one node with one mesh; `fill` makes its primitives. */
function oneMesh(fill, node = {}, mesh = {}) {
  return async (which) => {
    const document = gltf.startDocument([{ ...SUBJECT, ...node }]);
    gltf.putMesh(document, [await fill(document, which)].flat(), mesh);
    return document;
  };
}

/** The ring as most exporters write it. */
function ringPrimitive(document, which, componentType = gltf.UNSIGNED_SHORT) {
  const shape = ring(which);
  return { attributes: gltf.putSurface(document, shape),
    indices: gltf.putIndices(document, shape.triangles.flat(), componentType) };
}

const indexed = (componentType) => oneMesh((document, which) => ringPrimitive(document, which, componentType));

const withoutIndices = oneMesh((document, which) => ({ attributes: gltf.putSurface(document, unshared(ring(which))) }));

const strip = (mode) => oneMesh((document, which) => ({ mode, attributes: gltf.putSurface(document, ring(which)),
  indices: gltf.putIndices(document, ringStrip()) }));

/** One band of the ring: no indices, since a strip's corners are its vertices. */
const stripWithoutIndices = oneMesh((document, which) => {
  const shape = ring(which);
  const pick = (rows) => ringStrip().slice(0, 2 * (COLUMNS + 1)).map((i) => rows[i]);
  const band = { points: pick(shape.points), normals: pick(shape.normals), uvs: pick(shape.uvs) };
  return { mode: 5, attributes: gltf.putSurface(document, band) };
});

const fan = oneMesh((document, which) => {
  const shape = disc(which);
  const rim = shape.points.slice(1).map((_, i) => 1 + i);
  return { mode: 6, attributes: gltf.putSurface(document, shape), indices: gltf.putIndices(document, [0, ...rim, 1]) };
});

const interleaved = oneMesh((document, which) => {
  const shape = ring(which);
  const rows = shape.points.map((p, i) => [...p, ...shape.normals[i], ...shape.uvs[i]]);
  const bufferView = gltf.putView(document, gltf.packRows(rows, gltf.FLOAT, 32), { byteStride: 32, target: gltf.VERTICES });
  const put = (values, byteOffset, bounds) =>
    gltf.describeAccessor(document, values, gltf.FLOAT, { bufferView, byteOffset }, bounds);
  return { attributes: { POSITION: put(shape.points, 0, true), NORMAL: put(shape.normals, 12), TEXCOORD_0: put(shape.uvs, 24) },
    indices: gltf.putIndices(document, shape.triangles.flat()) };
});

/** Positions of which some, or all, are told apart from their place in the view. */
const sparse = (isAlone) => oneMesh((document, which) => {
  const { points, normals, triangles } = ring(which);
  const isTold = (i) => isAlone || i % 3 === 1;
  const told = points.map((_, i) => i).filter(isTold);
  const base = points.map((p, i) => (isTold(i) ? [9, 9, 9] : p));
  const packed = gltf.packRows(base, gltf.FLOAT, 12);
  const bufferView = isAlone ? {} : { bufferView: gltf.putView(document, packed, { target: gltf.VERTICES }) };
  const indices = { bufferView: gltf.putView(document, gltf.packRows(told.map((i) => [i]), gltf.UNSIGNED_BYTE, 1)),
    componentType: gltf.UNSIGNED_BYTE };
  const values = { bufferView: gltf.putView(document, gltf.packRows(told.map((i) => points[i]), gltf.FLOAT, 12)) };
  const fields = { ...bufferView, sparse: { count: told.length, indices, values } };
  const POSITION = gltf.describeAccessor(document, points, gltf.FLOAT, fields, true);
  return { attributes: { POSITION, NORMAL: gltf.putFloats(document, normals) },
    indices: gltf.putIndices(document, triangles.flat()) };
});

const QUANTISED = { extensionsUsed: ['KHR_mesh_quantization'], extensionsRequired: ['KHR_mesh_quantization'] };

/** Rounds points to integers of +-`most`, or of 0..`most`, axis by axis. @return rows and the node that undoes it */
function quantise(points, most, isSigned) {
  const sides = [0, 1, 2].map((k) => {
    const [low, high] = [Math.min(...points.map((p) => p[k])), Math.max(...points.map((p) => p[k]))];
    return isSigned ? { origin: (low + high) / 2, size: (high - low) / 2 } : { origin: low, size: high - low };
  });
  return { rows: points.map((p) => p.map((x, k) => Math.round(most * (x - sides[k].origin) / sides[k].size))),
    node: (unitSize) => ({ translation: sides.map(({ origin }) => origin), scale: sides.map(({ size }) => size / unitSize) }) };
}

const quantised = (componentType, most, normalized) => async (which) => {
  const shape = ring(which);
  const { rows, node } = quantise(shape.points, most, componentType === gltf.BYTE || componentType === gltf.SHORT);
  const document = gltf.startDocument([{ ...SUBJECT, ...node(normalized ? 1 : most) }]);
  const rounded = (list, unit) => list.map((row) => row.map((x) => Math.round(unit * x)));
  gltf.putMesh(document, [{
    attributes: {
      POSITION: gltf.putAccessor(document, rows, componentType, { bounds: true, ...(normalized && { normalized }) }, gltf.VERTICES),
      NORMAL: gltf.putAccessor(document, rounded(shape.normals, 127), gltf.BYTE, { normalized: true }, gltf.VERTICES),
      TEXCOORD_0: gltf.putAccessor(document, rounded(shape.uvs, 65535), gltf.UNSIGNED_SHORT, { normalized: true }, gltf.VERTICES),
    },
    indices: gltf.putIndices(document, shape.triangles.flat()),
  }]);
  Object.assign(document.json, QUANTISED);
  return document;
};

const plainRing = (node, mesh) => oneMesh((document, which) => ringPrimitive(document, which), node, mesh);

async function nested(which) {
  const document = await plainRing()(which);
  const size = which === 'a' ? 1 : 1.25;
  document.json.nodes = [{ name: 'root', translation: [1, 2, 3], rotation: TURN, children: [1] },
    { name: 'arm', scale: [size, 0.8, 1], children: [2, 3] }, { ...SUBJECT, rotation: [0, 0.6, 0, 0.8] },
    { name: 'empty', translation: [0, 1, 0] }];
  return document;
}

const mirrored = plainRing({ scale: [-1, 1, 1], translation: [3, 0, 0] });

const byMatrix = plainRing({ matrix: [0, 0, -1.5, 0, 0, 2, 0, 0, 0.5, 0, 0, 0, 4, 5, 6, 1] });

/** Two materials of one texture; `place` puts the image's bytes and says where. */
function paint(document, place) {
  Object.assign(document.json, {
    images: [{ name: 'checks', ...place(drawChecks(16, [230, 200, 150], [90, 60, 40])) }],
    samplers: [{ magFilter: 9728, minFilter: 9987, wrapS: 33071, wrapT: 33648 }],
    textures: [{ source: 0, sampler: 0 }],
    materials: [{ name: 'skin', doubleSided: true,
      pbrMetallicRoughness: { baseColorTexture: { index: 0 }, metallicFactor: 0.1, roughnessFactor: 0.7 } },
    { name: 'glass', alphaMode: 'MASK', alphaCutoff: 0.25, emissiveFactor: [0.1, 0, 0.2],
      pbrMetallicRoughness: { baseColorFactor: [0.2, 0.4, 0.9, 0.5], metallicRoughnessTexture: { index: 0 } },
      occlusionTexture: { index: 0, strength: 0.5 } }],
  });
}

/** A second texture, for the first material's relief. */
function addRelief({ json }, place) {
  json.images.push({ name: 'dents', ...place(drawChecks(8, [128, 128, 255], [120, 130, 250])) });
  json.samplers.push({ name: 'default' });
  json.textures.push({ source: 1, sampler: 1, name: 'relief' });
  json.materials[0].normalTexture = { index: 1, scale: 0.5 };
}

const intoView = (document) => (bytes) => ({ bufferView: gltf.putView(document, bytes), mimeType: 'image/png' });

const tangentsOf = ({ normals }) => normals.map((n) => [...unit(cross(n, [0.31, 0.95, 0.02])).map(Math.fround), 1]);

/** Every attribute of the specification, and one of our own. */
async function textured(which) {
  const document = gltf.startDocument([{ ...SUBJECT }]);
  const shape = ring(which);
  const attributes = { ...gltf.putSurface(document, shape), TANGENT: gltf.putFloats(document, tangentsOf(shape)),
    TEXCOORD_1: gltf.putFloats(document, shape.uvs.map(([u, v]) => [v, u])),
    COLOR_0: gltf.putAccessor(document, shape.uvs.map(([u, v]) => [u, v, 0.5, 1].map((x) => Math.round(255 * x))),
      gltf.UNSIGNED_BYTE, { normalized: true }, gltf.VERTICES),
    _HEAT: gltf.putFloats(document, shape.uvs.map(([u]) => [u * u])) };
  gltf.putMesh(document, [{ attributes, indices: gltf.putIndices(document, shape.triangles.flat()), material: 0 }]);
  paint(document, intoView(document));
  addRelief(document, intoView(document));
  document.json.materials.pop();
  return document;
}

async function textureTransform(which) {
  const document = await textured(which);
  document.json.extensionsUsed = ['KHR_texture_transform'];
  document.json.materials[0].pbrMetallicRoughness.baseColorTexture.extensions =
    { KHR_texture_transform: { offset: [0.25, 0.5], rotation: 0.3, scale: [2, 3], texCoord: 1 } };
  return document;
}

/** Two materials on two pieces that share no vertex. */
async function pieces(which) {
  const document = gltf.startDocument([{ ...SUBJECT }]);
  gltf.putMesh(document, [0, 1].map((part) => {
    const piece = pieceOf(ring(which), part, 2);
    return { attributes: gltf.putSurface(document, piece), indices: gltf.putIndices(document, piece.triangles.flat()),
      material: part };
  }));
  paint(document, intoView(document));
  return document;
}

/** Two primitives whose indices reach into the same vertices. */
const sharedVertices = oneMesh((document, which) => {
  const shape = ring(which);
  const attributes = gltf.putSurface(document, shape);
  const corners = shape.triangles.flat();
  const half = 3 * Math.floor(corners.length / 6);
  return [corners.slice(0, half), corners.slice(half)].map((list) => ({ attributes, indices: gltf.putIndices(document, list) }));
});

/** The same with a target, so that what a primitive does not use has other positions in it; 'a' rests part of the way. */
async function sharedVerticesWithTargets(which) {
  const document = await sharedVertices(which);
  const [mesh] = document.json.meshes;
  const { points } = ring(which);
  const moved = gltf.putPoints(document, points.map(([x, y, z]) => [0.31 * y, 0.17 * z, -0.23 * x].map(Math.fround)));
  for (const primitive of mesh.primitives) primitive.targets = [{ POSITION: moved }];
  Object.assign(mesh, { weights: [0.3], extras: { targetNames: ['own'] } });
  return document;
}

/** Two primitives of one list of positions, which targets of their own move elsewhere. */
async function sharedVerticesApart(which) {
  const document = await sharedVerticesWithTargets(which);
  const [{ primitives }] = document.json.meshes;
  primitives[1].targets = [{ POSITION: gltf.putPoints(document, ring(which).points.map(([x]) => [0, Math.fround(x), 0])) }];
  return document;
}

/** A stand of another mesh and material beside the subject. */
async function severalMeshes(which) {
  const document = gltf.startDocument([{ name: 'stand', mesh: 0, translation: [0, -2, 0], children: [1] },
    { ...SUBJECT, mesh: 1, translation: [0, 2.5, 0] }]);
  const stand = disc('a', 12);
  gltf.putMesh(document, [{ attributes: gltf.putSurface(document, stand),
    indices: gltf.putIndices(document, stand.triangles.flat()) }], { name: 'plate' });
  gltf.putMesh(document, [ringPrimitive(document, which)], { name: 'ring' });
  document.json.nodes.push({ name: 'elsewhere', mesh: 0 });
  document.json.scenes = [{ name: 'stand alone', nodes: [2] }, { nodes: [0] }];
  document.json.scene = 1;
  return document;
}

async function instanced(which) {
  const document = await plainRing()(which);
  document.json.nodes = [{ name: 'left', mesh: 0, translation: [-2, 0, 0] },
    { name: 'right', mesh: 0, translation: [2, 0, 0], scale: [1, 1.1, 1] }];
  document.json.scenes[0].nodes = [0, 1];
  return document;
}

/** Appends an animation. */
function animate(document, name, node, path, times, values, interpolation) {
  const rows = values.every(Array.isArray) ? values : values.map((x) => [x]);
  document.json.animations ??= [];
  document.json.animations.push({ name, channels: [{ sampler: 0, target: { node, path } }],
    samplers: [{ input: gltf.putTimes(document, times), output: gltf.putAccessor(document, rows, gltf.FLOAT),
      ...(interpolation && { interpolation }) }] });
}

/** A bind matrix of a joint at height y. */
const lowered = (y) => [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, -y, 0, 1];

/** Two joints, of which the second is bent; a clip that bends it. */
function skinned({ componentType, jointType, sum, firstJoint = 0 }) {
  return async (which) => {
    const document = gltf.startDocument([{ ...SUBJECT, skin: 0, translation: [7, 7, 7] },
      { name: 'hip', translation: [0, 0.1, 0], children: [2] },
      { name: 'head', translation: [0, 0.4, 0], rotation: [0, 0, 0.0998334166, 0.9950041653] }]);
    document.json.scenes[0].nodes = [0, 1];
    const primitive = ringPrimitive(document, which);
    const shares = ring('a').points.map(([x]) => Math.min(1, Math.max(0, (x + 1) / 2)));
    const rows = shares.map((share) => (sum === 1 ? [1 - Math.fround(share), Math.fround(share), 0, 0]
      : [sum - Math.round(sum * share), Math.round(sum * share), 0, 0]));
    const joints = shares.map((share) => [firstJoint, share > 0 ? firstJoint + 1 : 0, 0, 0]);
    primitive.attributes.JOINTS_0 = gltf.putAccessor(document, joints, jointType, {}, gltf.VERTICES);
    primitive.attributes.WEIGHTS_0 =
      gltf.putAccessor(document, rows, componentType, sum === 1 ? {} : { normalized: true }, gltf.VERTICES);
    gltf.putMesh(document, [primitive]);
    document.json.skins = [{ name: 'bones', joints: [1, 2], skeleton: 1,
      inverseBindMatrices: gltf.putAccessor(document, [lowered(0.1), lowered(0.5)], gltf.FLOAT) }];
    animate(document, 'nod', 2, 'rotation', [0, 1], [[0, 0, 0, 1], [0, 0, 0.479425539, 0.877582562]]);
    return document;
  };
}

/** A skin whose node is large and elsewhere, which matters only without it; `twin` has the same mesh and skin. */
const displaced = (hasTwin) => async (which) => {
  const document = await skin(which);
  const { nodes, scenes } = document.json;
  delete document.json.meshes[0].primitives[0].attributes.TEXCOORD_0;  // of no use, and once more in a copy of the mesh
  Object.assign(nodes[0], { translation: [10, -20, 30], rotation: TURN, scale: [100, 100, 50] });
  if (hasTwin) scenes[0].nodes.push(nodes.push({ name: 'twin', mesh: 0, skin: 0 }) - 1);
  return document;
};

/** A skin whose first joint hides what hangs on it: nothing. */
const skinWithFlatJoint = async (which) => {
  const document = await skinned({ componentType: gltf.FLOAT, jointType: gltf.UNSIGNED_SHORT, sum: 1, firstJoint: 1 })(which);
  document.json.nodes.push({ name: 'hidden', scale: [0, 0, 0] }, { name: 'root', children: [1, 3] });
  document.json.scenes[0].nodes = [0, 4];
  const [bones] = document.json.skins;
  delete bones.skeleton;
  bones.joints.unshift(3);
  bones.inverseBindMatrices = gltf.putAccessor(document, [0, 0.1, 0.5].map(lowered), gltf.FLOAT);
  return document;
};

const skin = skinned({ componentType: gltf.UNSIGNED_SHORT, jointType: gltf.UNSIGNED_BYTE, sum: 65535 });

/** Targets 'wide' and 'tall'; with `normals` they move normals too. */
function putTargets(document, primitive, which, { normals = false, zeros = false } = {}) {
  const { points } = ring(which);
  const wide = points.map(([x]) => [Math.fround(0.3 * x), 0, 0]);
  const tall = points.map(([, y]) => [0, Math.fround(0.5 * y), 0]);
  const still = points.map(() => [0, 0, 0]);
  primitive.targets = [wide, tall].map((rows) => ({ POSITION: gltf.putPoints(document, rows),
    ...(normals && { NORMAL: gltf.putFloats(document, still.map(() => [0, 0.01, 0])) }) }));
  if (zeros) primitive.targets.push({ POSITION: gltf.describeAccessor(document, still, gltf.FLOAT, {}, true) });
  return primitive;
}

const TARGET_NAMES = { extras: { targetNames: ['wide', 'tall'], artist: 'someone' } };

/** Targets with a clip of their weights. */
const animatedTargets = (interpolation, values, node = {}) => async (which) => {
  const document = gltf.startDocument([{ ...SUBJECT, ...node }]);
  gltf.putMesh(document, [putTargets(document, ringPrimitive(document, which), which, { normals: interpolation === 'STEP' })],
    { weights: [0, 0], ...TARGET_NAMES });
  animate(document, 'breath', 0, 'weights', [0, 0.5, 2], values, interpolation);
  animate(document, 'drift', 0, 'translation', [0, 2], [[0, 0, 0], [0, 1, 0]]);
  return document;
};

const LINEAR_WEIGHTS = [0, 0, 1, 0, 0.25, 0.5];
const CUBIC_WEIGHTS = [0, 0, 0, 0, 0.5, 0, 0, 0.1, 1, 0, 0, 0.2, 0, 0, 0.25, 0.5, 0, 0];

/** Targets that weigh something at rest: the shape is what a viewer shows. */
const restingTargets = oneMesh((document, which) => putTargets(document, ringPrimitive(document, which), which), {},
  { weights: [0.5, 0.25], ...TARGET_NAMES });

/** A target that moves colours and texture coordinates too. */
async function colouredTarget(which) {
  const document = await textured(which);
  const [{ primitives: [primitive] }] = document.json.meshes;
  const { points } = ring(which);
  putTargets(document, primitive, which);
  Object.assign(primitive.targets[1], {
    COLOR_0: gltf.putAccessor(document, points.map(() => [-0.25, 0.125, 0, 0]), gltf.FLOAT),
    TEXCOORD_0: gltf.putAccessor(document, points.map(() => [0.5, 0]), gltf.FLOAT) });
  return document;
}

/** Weights as bytes, for two nodes of one mesh by one sampler. */
async function instancedTargets(which) {
  const document = gltf.startDocument([{ ...SUBJECT }, { name: 'twin', mesh: 0, translation: [4, 0, 0], weights: [0, 1] }]);
  document.json.scenes[0].nodes = [0, 1];
  gltf.putMesh(document, [putTargets(document, ringPrimitive(document, which), which)], { weights: [0, 0] });
  const rows = LINEAR_WEIGHTS.map((w) => [Math.round(255 * w)]);
  document.json.animations = [{ channels: [0, 1].map((node) => ({ sampler: 0, target: { node, path: 'weights' } })),
    samplers: [{ input: gltf.putTimes(document, [0, 0.5, 2]),
      output: gltf.putAccessor(document, rows, gltf.UNSIGNED_BYTE, { normalized: true }) }] }];
  return document;
}

/** Two meshes whose weights one sampler moves: what is padded for one must not be for the other. */
async function sharedSampler(which) {
  const document = gltf.startDocument([{ name: 'other', mesh: 0, translation: [4, 0, 0] }, { ...SUBJECT, mesh: 1 }]);
  document.json.scenes[0].nodes = [0, 1];
  for (const shape of ['a', which])
    gltf.putMesh(document, [putTargets(document, ringPrimitive(document, shape), shape)], { weights: [0, 0] });
  animate(document, 'both', 1, 'weights', [0, 0.5, 2], LINEAR_WEIGHTS);
  document.json.animations[0].channels.push({ sampler: 0, target: { node: 0, path: 'weights' } });
  return document;
}

/** Two clips of their own times that read the same weights. */
async function sharedOutput(which) {
  const document = await animatedTargets('LINEAR', LINEAR_WEIGHTS)(which);
  const { animations } = document.json;
  const [{ output }] = animations[0].samplers;
  animations.push({ name: 'slow', channels: structuredClone(animations[0].channels),
    samplers: [{ input: gltf.putTimes(document, [0, 1, 4]), output }] });
  animations.push({ ...structuredClone(animations[0]), name: 'again' });
  return document;
}

/** Weights that KHR_animation_pointer moves: those of the node, and those of the mesh. */
async function pointedWeights(which) {
  const document = await animatedTargets('LINEAR', LINEAR_WEIGHTS)(which);
  const { json } = document;
  const pointTo = (pointer) => ({ path: 'pointer', extensions: { KHR_animation_pointer: { pointer } } });
  json.animations[0].channels[0].target = pointTo('/nodes/0/weights');
  animate(document, 'mesh', 0, 'weights', [0, 0.5, 2], CUBIC_WEIGHTS, 'CUBICSPLINE');
  const [sampler] = json.animations.pop().samplers;
  const drift = json.animations.at(-1);  // a clip stays when a client leaves out this channel of it, as Babylon.js does
  drift.channels.push({ sampler: drift.samplers.push(sampler) - 1, target: pointTo('/meshes/0/weights') });
  json.extensionsUsed = ['KHR_animation_pointer'];
  return document;
}

/** Targets and a clip that are called as the new ones will be. */
async function takenNames(which) {
  const document = await animatedTargets('LINEAR', LINEAR_WEIGHTS)(which);
  document.json.meshes[0].extras = { targetNames: ['b', 'b-2'] };
  document.json.animations[0].name = 'taken-names';
  return document;
}

/** Two primitives with targets. */
async function targetsOfPieces(which) {
  const document = await pieces(which);
  document.json.meshes[0].primitives.forEach((primitive, part) => {
    const { points } = pieceOf(ring(which), part, 2);
    primitive.targets = [{ POSITION: gltf.putPoints(document, points.map(([x]) => [0, 0, Math.fround(0.2 * x)])) }];
  });
  return document;
}

const stillTargets = oneMesh((document, which) =>
  putTargets(document, ringPrimitive(document, which), which, { zeros: true }));

const namedTargets = oneMesh((document, which) => putTargets(document, ringPrimitive(document, which), which), {},
  { weights: [0, 0], ...TARGET_NAMES });

const EXTRAS = [{ tags: ['a', { deep: [1, 2.5, null, true] }], 'größe': '9″', small: 1.2345678901234567e-12, big: 1e300 },
  'only text', 7, {}, [], false];

/** What nobody but its maker knows, at every place that may hold it. */
async function unknown(which) {
  const document = await textured(which);
  const { json } = document;
  const known = (place) => ({ EXAMPLE_maker: { place, list: [0, -1, 0.1], object: {}, index: 0 } });
  const [material] = json.materials;
  const places = [json.asset, json.scenes[0], ...json.nodes, ...json.meshes, json.meshes[0].primitives[0], material,
    material.pbrMetallicRoughness, material.normalTexture, ...json.textures, ...json.images, ...json.samplers,
    ...json.accessors, ...json.bufferViews, json];
  places.forEach((place, i) => Object.assign(place, { extras: EXTRAS[i % EXTRAS.length], extensions: known(i) }));
  json.meshes[0].extras = { artist: 'someone', 'λ': [[], {}] };
  json.extensionsUsed = ['EXAMPLE_maker'];
  return document;
}

async function camerasAndLights(which) {
  const document = await plainRing()(which);
  const { json } = document;
  json.extensionsUsed = ['KHR_lights_punctual'];
  json.extensions = { KHR_lights_punctual: { lights: [{ type: 'directional', intensity: 2, color: [1, 0.9, 0.8] },
    { type: 'spot', name: 'lamp', range: 12.5, spot: { innerConeAngle: 0.2, outerConeAngle: 0.6 } }] } };
  json.cameras = [{ type: 'perspective', name: 'front', perspective: { yfov: 0.7, znear: 0.01, zfar: 100, aspectRatio: 1.5 } },
    { type: 'orthographic', orthographic: { xmag: 2, ymag: 2, znear: 0.1, zfar: 50 } }];
  json.nodes.push({ name: 'sun', extensions: { KHR_lights_punctual: { light: 0 } } }, { camera: 0, translation: [0, 0, 5] },
    { camera: 1, extensions: { KHR_lights_punctual: { light: 1 } } });
  json.scenes[0].nodes = [0, 1, 2, 3];
  return document;
}

/** Every corner a vertex of its own in shape 'b' only. */
const splitOtherwise = (which) => (which === 'a' ? plainRing() : withoutIndices)(which);

const MESHOPT = 'EXT_meshopt_compression';

/** As gltfpack writes it: quantised, packed, and nothing for readers that cannot unpack. */
async function meshopt(which) {
  const shape = ring(which);
  const { rows, node } = quantise(shape.points, 32767, true);
  const document = gltf.startDocument([{ ...SUBJECT, ...node(1) }]);
  let length = 0;
  const fallback = { buffer: 1, take: (bytes) => (length += bytes + (-bytes & 3)) - bytes - (-bytes & 3) };
  const vertices = { mode: 'ATTRIBUTES', target: gltf.VERTICES, fallback, accessor: { normalized: true } };
  const attributes = {
    POSITION: await putMeshopt(document, rows, { ...vertices, componentType: gltf.SHORT, stride: 8, bounds: true }),
    NORMAL: await putMeshopt(document, shape.normals,
      { ...vertices, componentType: gltf.BYTE, stride: 4, filter: 'OCTAHEDRAL' }),
  };
  const indices = await putMeshopt(document, shape.triangles.flat().map((i) => [i]),
    { componentType: gltf.UNSIGNED_SHORT, stride: 2, mode: 'TRIANGLES', target: gltf.INDICES, fallback });
  gltf.putMesh(document, [{ attributes, indices }]);
  document.json.extensionsUsed = [MESHOPT, ...QUANTISED.extensionsUsed];
  document.json.extensionsRequired = [...document.json.extensionsUsed];
  return Object.assign(document, { others: [{ byteLength: length, extensions: { [MESHOPT]: { fallback: true } } }] });
}

/** Float32, packed, with the plain bytes beside it. */
async function meshoptOptional(which) {
  const shape = ring(which);
  const document = gltf.startDocument([{ ...SUBJECT }]);
  const put = (rows, more) => putMeshopt(document, rows,
    { mode: 'ATTRIBUTES', target: gltf.VERTICES, componentType: gltf.FLOAT, stride: 12, ...more });
  const attributes = { POSITION: await put(shape.points, { bounds: true }), NORMAL: await put(shape.normals),
    TEXCOORD_0: await put(shape.uvs, { stride: 8 }) };
  const indices = await put(shape.triangles.flat().map((i) => [i]),
    { componentType: gltf.UNSIGNED_INT, stride: 4, mode: 'INDICES', target: gltf.INDICES });
  gltf.putMesh(document, [{ attributes, indices }]);
  document.json.extensionsUsed = [MESHOPT];
  return document;
}

const draco = (method) => oneMesh((document, which) => putDraco(document, ring(which), { method }));

/** Only one of two primitives packed, by an exporter that left a texture beside it. */
async function dracoBesidePlain(which) {
  const document = gltf.startDocument([{ ...SUBJECT }]);
  const [first, second] = [0, 1].map((part) => pieceOf(ring(which), part, 2));
  const plain = { attributes: gltf.putSurface(document, first), indices: gltf.putIndices(document, first.triangles.flat()),
    material: 0 };
  const packed = await putDraco(document, second);
  paint(document, intoView(document));
  gltf.putMesh(document, [plain, { ...packed, material: 1 }]);
  return document;
}

/** Draco that readers may leave alone: the plain numbers are there too. */
async function dracoOptional(which) {
  const document = gltf.startDocument([{ ...SUBJECT }]);
  const primitive = await putDraco(document, ring(which), { withPlain: true });
  gltf.putMesh(document, [primitive]);
  delete document.json.extensionsRequired;
  return document;
}

const single = (make) => async (which) => {
  const document = await make(which);
  return { main: `${which}.glb`, files: { [`${which}.glb`]: gltf.toGlb(document, document.others) } };
};

/** Two buffers and an image, all in data URIs. */
async function dataUris(which) {
  const document = await pieces(which);
  const { json } = document;
  json.images.forEach((image) => {
    const view = json.bufferViews[image.bufferView];
    const bytes = gltf.chunkOf(document).subarray(view.byteOffset, view.byteOffset + view.byteLength);
    image.uri = gltf.dataUri(bytes, 'image/png');
    delete image.bufferView, delete image.mimeType;
  });
  json.bufferViews.splice(-1);  // the image's, which is last
  const bin = gltf.chunkOf(document);
  const middle = json.bufferViews[4].byteOffset;
  for (const view of json.bufferViews.slice(4)) Object.assign(view, { buffer: 1, byteOffset: view.byteOffset - middle });
  const buffers = [bin.subarray(0, middle), bin.subarray(middle)].map((bytes) =>
    ({ byteLength: bytes.length, uri: gltf.dataUri(bytes) }));
  return { main: `${which}.gltf`, files: { [`${which}.gltf`]: gltf.toGltf(document, buffers) } };
}

const escaped = (name) => name.split('/').map(encodeURIComponent).join('/');

/** A .gltf with its data and picture beside it, under names that a URI must escape. */
async function external(which) {
  const document = gltf.startDocument([{ ...SUBJECT }]);
  gltf.putMesh(document, [{ ...ringPrimitive(document, which), material: 0 }]);
  const names = { bin: `data of ${which}/points & more #1.bin`, png: `data of ${which}/größe 100%.png` };
  const files = {};
  paint(document, (bytes) => {
    files[names.png] = bytes;
    return { uri: escaped(names.png) };
  });
  document.json.materials.pop();
  files[names.bin] = gltf.chunkOf(document);
  const buffers = [{ byteLength: files[names.bin].length, uri: escaped(names.bin), name: 'points' }];
  files[`${which} model.gltf`] = gltf.toGltf(document, buffers);
  return { main: `${which} model.gltf`, files };
}

const ENDING = Buffer.from('0123456789abcdef0123456789abcdef');

/** Pictures in the formats of extensions; of all but WebP only the beginnings: we look no further. */
const STRANGERS = [
  ['EXT_texture_webp', 'image/webp', drawWebp(8, [230, 150, 60])],
  ['KHR_texture_basisu', 'image/ktx2', Buffer.concat([Buffer.from('\xabKTX 20\xbb\r\n\x1a\n', 'latin1'), ENDING])],
  ['MSFT_texture_dds', 'image/vnd-ms.dds', Buffer.concat([Buffer.from('DDS |\0\0\0', 'latin1'), ENDING])],
  ['EXT_texture_avif', 'image/avif', Buffer.concat([Buffer.from('\0\0\0\x1cftypavif', 'latin1'), ENDING])],
];

/** Textures of extensions, each beside one of PNG for those who do not know it; `place(files, bytes, mimeType, name)` says where. */
const strangers = (kinds, place) => async (which) => {
  const document = gltf.startDocument([{ ...SUBJECT }]);
  gltf.putMesh(document, [{ ...ringPrimitive(document, which), material: 0 }]);
  const { json } = document;
  const files = {};
  const put = (bytes, mimeType, i) => ({ uri: place(files, bytes, mimeType, `${which}+${i}.${mimeType.slice(-4)}`), mimeType });
  json.images = [put(drawChecks(8, [230, 200, 150], [90, 60, 40]), 'image/png', 0),
    ...kinds.map(([, mimeType, bytes], i) => put(bytes, mimeType, i + 1))];
  json.textures = kinds.map(([name], i) => ({ source: 0, extensions: { [name]: { source: i + 1 } } }));
  json.materials = kinds.map((_, index) => ({ pbrMetallicRoughness: { baseColorTexture: { index } } }));
  json.extensionsUsed = kinds.map(([name]) => name);
  const bin = gltf.chunkOf(document);
  files[`${which}+points.bin`] = Buffer.concat([bin, ENDING]);  // longer than its buffer, which is legal
  files[`${which}.gltf`] = gltf.toGltf(document, [{ byteLength: bin.length, uri: `${which}+points.bin` }]);
  return { main: `${which}.gltf`, files };
};

const percentEncoded = (bytes, type) => `data:${type},${[...bytes].map((b) => `%${b.toString(16).padStart(2, '0')}`).join('')}`;

/** Indices and counts as some exporters write them: 1.0 for 1, but for numbers of extras. */
async function floatingIntegers(which) {
  const { main, files } = await external(which);
  const text = files[main].toString();
  const parts = text.match(/"(?:\\.|[^"\\])*"|[^"]+/g);
  const pointed = parts.map((part) => (part.startsWith('"') ? part : part.replace(/(?<![\d.eE+-])\d+(?![\d.eE])/g, '$&.0')));
  files[main] = Buffer.from(pointed.join(''));
  return { main, files };
}

const picturesBeside = strangers(STRANGERS, (files, bytes, type, name) => { files[name] = bytes; return name; });
const picturesInUris = strangers(STRANGERS.slice(0, 1), (files, bytes, type) =>
  (type === 'image/png' ? percentEncoded : gltf.dataUri)(bytes, type));

/** A .glb whose indices lie in a file beside it. */
async function besideGlb(which) {
  const document = await plainRing()(which);
  const view = document.json.bufferViews.at(-1);
  const bytes = document.chunks.pop();
  Object.assign(view, { buffer: 1, byteOffset: 0 });
  return { main: `${which}.glb`, files: { [`${which}.indices.bin`]: bytes.subarray(0, view.byteLength),
    [`${which}.glb`]: gltf.toGlb(document, [{ byteLength: view.byteLength, uri: `${which}.indices.bin` }]) } };
}

const REST = {};

/** Both shapes are poses of a skin that the first one loses. */
const NODS = { a: { animation: { name: 'nod', time: 0.6 } }, b: { animation: { name: 'nod', time: 0.1 } }, dropsSkin: true,
  moments: { a: { animation: 0, time: 0.6 }, b: { animation: 0, time: 0.1 } } };

/** Form 'a' by one maker, 'b' by another. */
const mixed = (a, b) => (which) => (which === 'a' ? a : b)(which);

/**
 * name: make(which) -> {main, files: {name: bytes}}; and what a recipe's source says beside the file:
 * `select` for both shapes, `a` or `b` for one; `moments` of the sources as reference/scene.mjs wants them; `start` is the
 * shape at 0 s when that is not 'a', which is always the source that is kept; `dropsSkin`: its subject is posed; `tells`
 * are kinds of the validator's messages that come of that.
 */
export const FORMS = {
  'indices-u8': { make: single(indexed(gltf.UNSIGNED_BYTE)) },
  'indices-u16': { make: single(indexed(gltf.UNSIGNED_SHORT)) },
  'indices-u32': { make: single(indexed(gltf.UNSIGNED_INT)) },
  'no-indices': { make: single(withoutIndices) },
  'strip': { make: single(strip(5)) },
  'strip-no-indices': { make: single(stripWithoutIndices) },
  'fan': { make: single(fan) },
  'interleaved': { make: single(interleaved) },
  'sparse': { make: single(sparse(false)) },
  'sparse-alone': { make: single(sparse(true)) },
  'bytes': { make: single(quantised(gltf.BYTE, 127, true)) },
  'shorts': { make: single(quantised(gltf.SHORT, 32767, true)) },
  'unsigned-shorts': { make: single(quantised(gltf.UNSIGNED_SHORT, 65535, true)) },
  'integers': { make: single(quantised(gltf.UNSIGNED_SHORT, 4095, false)) },
  'nested-nodes': { make: single(nested) },
  'mirrored-node': { make: single(mirrored) },
  'matrix-node': { make: single(byMatrix) },
  'data-uris': { make: dataUris },
  'external': { make: external },
  'beside-glb': { make: besideGlb },
  'floating-integers': { make: floatingIntegers },
  'pictures-beside': { make: picturesBeside },
  'pictures-in-uris': { make: picturesInUris },
  'textured': { make: single(textured) },
  'texture-transform': { make: single(textureTransform) },
  'primitives': { make: single(pieces) },
  'shared-vertices': { make: single(sharedVertices) },
  'shared-vertices-apart': { make: single(sharedVerticesApart), start: 'b' },
  'shared-vertices-resting': { make: single(sharedVerticesWithTargets), start: 'b' },
  'shared-vertices-target': { make: single(sharedVerticesWithTargets), a: { target: 'own' },
    moments: { a: { weights: [1] } } },
  'sparse-from-b': { make: single(sparse(false)), start: 'b' },
  'several-by-node': { make: single(severalMeshes), select: { node: 'subject' } },
  'several-by-mesh': { make: single(severalMeshes), select: { mesh: 'ring' } },
  'several-by-index': { make: single(severalMeshes), select: { node: 1 } },
  'instanced': { make: single(instanced), select: { node: 'right' } },
  'skin': { make: single(skin) },
  'skin-floats': { make: single(skinned({ componentType: gltf.FLOAT, jointType: gltf.UNSIGNED_SHORT, sum: 1 })) },
  'skin-flat-joint': { make: single(skinWithFlatJoint) },
  'targets-linear': { make: single(animatedTargets('LINEAR', LINEAR_WEIGHTS)) },
  'targets-step': { make: single(animatedTargets('STEP', LINEAR_WEIGHTS)) },
  'targets-cubic': { make: single(animatedTargets('CUBICSPLINE', CUBIC_WEIGHTS, { weights: [0, 0] })) },
  'targets-colours': { make: single(colouredTarget) },
  'targets-instanced': { make: single(instancedTargets), select: { node: 'subject' } },
  'targets-shared-sampler': { make: single(sharedSampler), select: { node: 'subject' } },
  'targets-shared-output': { make: single(sharedOutput) },
  'targets-pointer': { make: single(pointedWeights) },
  'taken-names': { make: single(takenNames) },
  'targets-resting': { make: single(restingTargets) },
  'targets-primitives': { make: single(targetsOfPieces) },
  'targets-zeros': { make: single(stillTargets) },
  'from-target': { make: single(namedTargets), a: { target: 'wide' }, b: { target: 1 },
    moments: { a: { weights: [1, 0] }, b: { weights: [0, 1] } } },
  'to-target': { make: single(namedTargets), b: { target: 'tall' }, moments: { a: REST, b: { weights: [0, 1] } } },
  'from-animation': { make: single(animatedTargets('CUBICSPLINE', CUBIC_WEIGHTS)),
    a: { animation: { time: 0.2 } }, b: { animation: { name: 'breath', time: 1.3 } },
    moments: { a: { animation: 0, time: 0.2 }, b: { animation: 0, time: 1.3 } } },
  'from-pointer': { make: single(pointedWeights), a: { animation: { name: 'breath', time: 0.25 } },
    b: { animation: { name: 'breath', time: 2 } }, moments: { a: { weights: [0.5, 0] }, b: { weights: [0.25, 0.5] } } },
  'to-pose': { make: mixed(single(plainRing()), single(skin)), b: { animation: { name: 0, time: 0.6 } },
    moments: { a: REST, b: { animation: 0, time: 0.6 } } },
  'from-pose': { make: single(displaced(false)), ...NODS, tells: ['info: NODE_EMPTY'] },  // a leaf that is no joint any more
  'from-pose-with-twin': { make: single(displaced(true)), select: { node: 'subject' }, ...NODS },
  'unknown': { make: single(unknown) },
  'cameras-lights': { make: single(camerasAndLights) },
  'split-otherwise': { make: single(splitOtherwise) },
  'meshopt': { make: single(meshopt) },
  'meshopt-optional': { make: single(meshoptOptional) },
  'draco': { make: single(draco('MESH_EDGEBREAKER_ENCODING')) },
  'draco-sequential': { make: single(draco('MESH_SEQUENTIAL_ENCODING')) },
  'draco-optional': { make: single(dracoOptional) },
  'draco-beside-plain': { make: single(dracoBesidePlain) },
};

/** Writes both shapes of a form. @return {a, b}: their files */
export async function writeForm(name, folder) {
  const written = {};
  for (const which of ['a', 'b']) {
    const { main, files } = await FORMS[name].make(which);
    for (const [file, bytes] of Object.entries(files)) {
      mkdirSync(path.dirname(path.join(folder, file)), { recursive: true });
      writeFileSync(path.join(folder, file), bytes);
    }
    written[which] = path.join(folder, main);
  }
  return written;
}

if (import.meta.url === pathToFileURL(process.argv[1] ?? '').href)
  for (const name of Object.keys(FORMS)) await writeForm(name, path.join(process.argv[2], name));
