// Reads .glb files. Written from the glTF 2.0 specification, to share nothing with what writes ours.

const COMPONENTS = {
  5120: { array: Int8Array, size: 1, range: 127 },
  5121: { array: Uint8Array, size: 1, range: 255 },
  5122: { array: Int16Array, size: 2, range: 32767 },
  5123: { array: Uint16Array, size: 2, range: 65535 },
  5125: { array: Uint32Array, size: 4, range: 4294967295 },
  5126: { array: Float32Array, size: 4, range: 1 },
};
const WIDTHS = { SCALAR: 1, VEC2: 2, VEC3: 3, VEC4: 4, MAT2: 4, MAT3: 9, MAT4: 16 };

/** Splits a .glb into its JSON and its binary chunk. */
export function parseGlb(file) {
  // A copy as plain bytes: Node's Buffer has a slice() that does not copy.
  const bytes = new Uint8Array(file);
  const view = new DataView(bytes.buffer, bytes.byteOffset, bytes.byteLength);
  if (view.getUint32(0, true) !== 0x46546c67) throw new Error('not a .glb file');
  if (view.getUint32(8, true) !== bytes.byteLength) throw new Error('.glb length field is wrong');
  const glb = { json: null, bin: new Uint8Array(0) };
  for (let at = 12; at < bytes.byteLength; ) {
    const length = view.getUint32(at, true);
    const type = view.getUint32(at + 4, true);
    const chunk = bytes.subarray(at + 8, at + 8 + length);
    if (type === 0x4e4f534a) glb.json = JSON.parse(new TextDecoder('utf-8', { fatal: true }).decode(chunk));
    if (type === 0x004e4942) glb.bin = chunk;
    at += 8 + length;
  }
  return glb;
}

/** One accessor as float64 (normalised integers are mapped to their range), sparse values applied. */
export function readAccessor(glb, index) {
  const accessor = glb.json.accessors[index];
  const width = WIDTHS[accessor.type];
  const layout = { componentType: accessor.componentType, width, count: accessor.count };
  const values = accessor.bufferView === undefined
    ? new Float64Array(accessor.count * width)
    : readElements(glb, accessor.bufferView, accessor.byteOffset ?? 0, layout);
  if (accessor.sparse) applySparse(glb, accessor, width, values);
  if (accessor.normalized) {
    const { range } = COMPONENTS[accessor.componentType];
    for (let i = 0; i < values.length; i++) values[i] = Math.max(values[i] / range, -1);
  }
  return values;
}

function readElements(glb, viewIndex, offset, { componentType, width, count }) {
  const bufferView = glb.json.bufferViews[viewIndex];
  const { array, size } = COMPONENTS[componentType];
  const stride = bufferView.byteStride ?? size * width;
  const start = (bufferView.byteOffset ?? 0) + offset;
  const values = new Float64Array(count * width);
  for (let i = 0; i < count; i++) {
    const from = start + i * stride;
    // A copy, because typed arrays demand an alignment that a chunk in a file buffer may not have.
    values.set(new array(glb.bin.slice(from, from + size * width).buffer), i * width);
  }
  return values;
}

function applySparse(glb, accessor, width, values) {
  const { count, indices, values: replacements } = accessor.sparse;
  const at = readElements(glb, indices.bufferView, indices.byteOffset ?? 0,
    { componentType: indices.componentType, width: 1, count });
  const by = readElements(glb, replacements.bufferView, replacements.byteOffset ?? 0,
    { componentType: accessor.componentType, width, count });
  for (let i = 0; i < count; i++) values.set(by.subarray(i * width, (i + 1) * width), at[i] * width);
}

/** Corner indices of a triangle-list primitive. */
export function readTriangles(glb, primitive) {
  if ((primitive.mode ?? 4) !== 4) throw new Error('the reference reads triangle lists only');
  if (primitive.indices !== undefined) return readAccessor(glb, primitive.indices);
  return Float64Array.from({ length: glb.json.accessors[primitive.attributes.POSITION].count }, (_, i) => i);
}

/** The single node with a mesh, and its global matrix (16 values, column-major). */
export function findMeshNode(glb) {
  const nodes = glb.json.nodes ?? [];
  const withMesh = nodes.flatMap((node, i) => (node.mesh === undefined ? [] : [i]));
  if (withMesh.length !== 1) throw new Error(`expected one node with a mesh, found ${withMesh.length}`);
  let matrix = localMatrix(nodes[withMesh[0]]);
  for (let child = withMesh[0]; ; ) {
    const parent = nodes.findIndex((node) => node.children?.includes(child));
    if (parent < 0) return { node: nodes[withMesh[0]], matrix };
    matrix = multiply(localMatrix(nodes[parent]), matrix);
    child = parent;
  }
}

/** The matrix of one node, column-major. */
export function localMatrix(node) {
  if (node.matrix) return node.matrix;
  const [x, y, z, w] = node.rotation ?? [0, 0, 0, 1];
  const [sx, sy, sz] = node.scale ?? [1, 1, 1];
  const [tx, ty, tz] = node.translation ?? [0, 0, 0];
  return [
    sx * (1 - 2 * (y * y + z * z)), sx * 2 * (x * y + z * w), sx * 2 * (x * z - y * w), 0,
    sy * 2 * (x * y - z * w), sy * (1 - 2 * (x * x + z * z)), sy * 2 * (y * z + x * w), 0,
    sz * 2 * (x * z + y * w), sz * 2 * (y * z - x * w), sz * (1 - 2 * (x * x + y * y)), 0,
    tx, ty, tz, 1,
  ];
}

/** The product of two matrices, column-major. */
export function multiply(a, b) {
  const product = new Array(16).fill(0);
  for (let column = 0; column < 4; column++)
    for (let row = 0; row < 4; row++)
      for (let k = 0; k < 4; k++) product[4 * column + row] += a[4 * k + row] * b[4 * column + k];
  return product;
}
