// What a viewer shows of a plain glTF (plain.mjs) at one moment: morphed, skinned and placed, in float64.
import { localMatrix, multiply, readAccessor } from './glb.mjs';

const STRIP = 5;
const FAN = 6;

/** Corner indices of a primitive of triangles: list, strip or fan, with indices or without. */
export function cornersOf(plain, primitive) {
  const { count } = plain.json.accessors[primitive.attributes.POSITION];
  const list = primitive.indices === undefined ? Array.from({ length: count }, (_, i) => i)
    : [...readAccessor(plain, primitive.indices)];
  if (primitive.mode !== STRIP && primitive.mode !== FAN) return list;
  const triangles = Array.from({ length: list.length - 2 }, (_, i) => {
    if (primitive.mode === FAN) return [list[i + 1], list[i + 2], list[0]];
    return i % 2 ? [list[i], list[i + 2], list[i + 1]] : [list[i], list[i + 1], list[i + 2]];
  });
  return triangles.filter(([a, b, c]) => a !== b && b !== c && c !== a).flat();
}

/**
 * The nodes with a mesh, in the file's order.
 *
 * @param moment  {animation: index, time: seconds}, or {weights} of every mesh; without both the file as it rests
 * @return        {node, mesh, primitives: [{positions: #V by 3 in the scene, corners}]} a node
 */
export function evaluateScene(plain, moment = {}) {
  const posed = poseNodes(plain, moment);
  const globals = posed.map((_, i) => globalMatrix(posed, i));
  return posed.flatMap((node, i) => (node.mesh === undefined ? [] : [{
    node: i, mesh: node.mesh,
    primitives: plain.json.meshes[node.mesh].primitives.map((primitive) => ({
      corners: cornersOf(plain, primitive),
      positions: placePoints(plain, primitive, morph(plain, primitive, weightsOf(plain, node)), node, globals, i) })),
  }]));
}

const weightsOf = (plain, node) => node.weights ?? plain.json.meshes[node.mesh].weights ?? [];

function morph(plain, primitive, weights) {
  const points = readAccessor(plain, primitive.attributes.POSITION);
  (primitive.targets ?? []).forEach((target, k) => {
    if (!weights[k] || target.POSITION === undefined) return;
    readAccessor(plain, target.POSITION).forEach((delta, i) => { points[i] += weights[k] * delta; });
  });
  return points;
}

function placePoints(plain, primitive, points, node, globals, index) {
  const matrixOf = node.skin === undefined ? () => globals[index] : skinMatrices(plain, primitive, node, globals);
  const placed = new Float64Array(points.length);
  for (let i = 0; 3 * i < points.length; i++) {
    const m = matrixOf(i);
    for (let row = 0; row < 3; row++)
      placed[3 * i + row] =
        m[row] * points[3 * i] + m[4 + row] * points[3 * i + 1] + m[8 + row] * points[3 * i + 2] + m[12 + row];
  }
  return placed;
}

/** (vertex) -> the weighted sum of its joints' matrices; the node's own does not count. */
function skinMatrices(plain, primitive, node, globals) {
  const { joints, inverseBindMatrices } = plain.json.skins[node.skin];
  const inverse = inverseBindMatrices === undefined ? null : readAccessor(plain, inverseBindMatrices);
  const matrices = joints.map((joint, k) =>
    (inverse ? multiply(globals[joint], inverse.subarray(16 * k, 16 * k + 16)) : globals[joint]));
  const sets = [];
  for (let set = 0; primitive.attributes[`JOINTS_${set}`] !== undefined; set++)
    sets.push([primitive.attributes[`JOINTS_${set}`], primitive.attributes[`WEIGHTS_${set}`]].map((at) => readAccessor(plain, at)));
  return (i) => {
    const sum = new Array(16).fill(0);
    for (const [joint, weight] of sets)
      for (let k = 4 * i; k < 4 * i + 4; k++)
        for (let entry = 0; weight[k] !== 0 && entry < 16; entry++) sum[entry] += weight[k] * matrices[joint[k]][entry];
    return sum;
  };
}

function globalMatrix(nodes, index) {
  let matrix = localMatrix(nodes[index]);
  for (let child = index; ; ) {
    const parent = nodes.findIndex((node) => node.children?.includes(child));
    if (parent < 0) return matrix;
    matrix = multiply(localMatrix(nodes[parent]), matrix);
    child = parent;
  }
}

/** The nodes with an animation's values at its moment written over theirs. */
function poseNodes(plain, { animation, time, weights }) {
  const nodes = structuredClone(plain.json.nodes ?? []);
  for (const node of nodes) if (weights && node.mesh !== undefined) node.weights = weights;
  if (animation === undefined) return nodes;
  const { channels, samplers } = plain.json.animations[animation];
  for (const { sampler, target } of channels)
    if (target.node !== undefined) nodes[target.node][target.path] = sampleAt(plain, samplers[sampler], target.path, time);
  return nodes;
}

/** What a sampler says at a time. @param path  of the channel: rotations are turned along arcs */
export function sampleAt(plain, { input, output, interpolation = 'LINEAR' }, path, time) {
  const times = readAccessor(plain, input);
  const values = readAccessor(plain, output);
  const isCubic = interpolation === 'CUBICSPLINE';
  const width = values.length / times.length / (isCubic ? 3 : 1);
  const row = (key, part = 1) => {
    const start = (isCubic ? 3 * key + part : key) * width;
    return [...values.subarray(start, start + width)];
  };
  const key = times.findLastIndex((t) => t <= time);
  if (key < 0) return row(0);
  if (key === times.length - 1 || interpolation === 'STEP') return row(key);
  const span = times[key + 1] - times[key];
  const u = (time - times[key]) / span;
  const found = isCubic ? hermite(row(key), row(key, 2), row(key + 1, 0), row(key + 1), u, span)
    : path === 'rotation' ? slerp(row(key), row(key + 1), u)
    : row(key).map((a, k) => a + u * (row(key + 1)[k] - a));
  return path === 'rotation' ? found.map((x) => x / Math.hypot(...found)) : found;
}

const hermite = (from, leaving, arriving, to, u, span) => from.map((a, k) =>
  (2 * u ** 3 - 3 * u ** 2 + 1) * a + span * (u ** 3 - 2 * u ** 2 + u) * leaving[k] +
  (3 * u ** 2 - 2 * u ** 3) * to[k] + span * (u ** 3 - u ** 2) * arriving[k]);

function slerp(a, b, u) {
  const cosine = a.reduce((sum, x, k) => sum + x * b[k], 0);
  const arc = Math.acos(Math.min(1, Math.abs(cosine)));
  if (arc < 1e-6) return a.map((x, k) => x + u * (Math.sign(cosine || 1) * b[k] - x));
  return a.map((x, k) => (Math.sin((1 - u) * arc) * x + Math.sign(cosine) * Math.sin(u * arc) * b[k]) / Math.sin(arc));
}
