// A glTF under construction: JSON, and bytes that its views take one after another.

const ARRAYS = { 5120: Int8Array, 5121: Uint8Array, 5122: Int16Array, 5123: Uint16Array,
  5125: Uint32Array, 5126: Float32Array };
export const BYTE = 5120;
export const UNSIGNED_BYTE = 5121;
export const SHORT = 5122;
export const UNSIGNED_SHORT = 5123;
export const UNSIGNED_INT = 5125;
export const FLOAT = 5126;
export const VERTICES = 34962;
export const INDICES = 34963;
const TYPES = { 1: 'SCALAR', 2: 'VEC2', 3: 'VEC3', 4: 'VEC4', 16: 'MAT4' };

/** An empty document with one scene of `nodes`. */
export const startDocument = (nodes = []) => ({
  json: { asset: { version: '2.0', generator: 'the forms of a test' }, scene: 0, scenes: [{ nodes: [0] }], nodes, meshes: [],
    accessors: [], bufferViews: [] },
  chunks: [], length: 0,
});

const pad = (bytes, filler = 0) => Buffer.concat([bytes, Buffer.alloc(-bytes.length & 3, filler)]);

/** Appends bytes as a view. @return its index */
export function putView(document, bytes, fields = {}) {
  document.json.bufferViews.push({ buffer: 0, byteOffset: document.length, byteLength: bytes.length, ...fields });
  document.chunks.push(pad(Buffer.from(bytes)));
  document.length += document.chunks.at(-1).length;
  return document.json.bufferViews.length - 1;
}

/** Rows of numbers as bytes with `stride` between rows. */
export function packRows(rows, componentType, stride) {
  const array = ARRAYS[componentType];
  const bytes = new Uint8Array(rows.length * stride);
  rows.forEach((row, i) => bytes.set(new Uint8Array(array.from(row).buffer), i * stride));
  return bytes;
}

export function boundsOf(rows, componentType) {
  const column = (k) => ARRAYS[componentType].from(rows, (row) => row[k]);
  const columns = rows[0].map((_, k) => column(k));
  return { min: columns.map((c) => Math.min(...c)), max: columns.map((c) => Math.max(...c)) };
}

/**
 * Appends rows of numbers as an accessor with a view of its own; rows of vertex attributes begin at multiples of 4 bytes.
 *
 * @param fields  of the accessor; `bounds: true` adds min and max
 * @param target  of the view: VERTICES, INDICES or none
 * @return        its index
 */
export function putAccessor(document, rows, componentType, { bounds, ...fields } = {}, target = undefined) {
  const size = rows[0].length * ARRAYS[componentType].BYTES_PER_ELEMENT;
  const stride = target === VERTICES ? Math.ceil(size / 4) * 4 : size;
  const view = { ...(target && { target }), ...(stride !== size && { byteStride: stride }) };
  const bufferView = putView(document, packRows(rows, componentType, stride), view);
  return describeAccessor(document, rows, componentType, { bufferView, ...fields }, bounds);
}

/** Appends an accessor of given fields for what `rows` say. */
export function describeAccessor(document, rows, componentType, fields, bounds = false) {
  document.json.accessors.push({ ...fields, componentType, count: rows.length, type: TYPES[rows[0].length],
    ...(bounds && boundsOf(rows, componentType)) });
  return document.json.accessors.length - 1;
}

export const putPoints = (document, points) => putAccessor(document, points, FLOAT, { bounds: true }, VERTICES);
export const putFloats = (document, rows) => putAccessor(document, rows, FLOAT, {}, VERTICES);
export const putTimes = (document, times) => putAccessor(document, times.map((t) => [t]), FLOAT, { bounds: true });
export const putNumbers = (document, numbers) => putAccessor(document, numbers.map((x) => [x]), FLOAT);
export const putIndices = (document, list, componentType = UNSIGNED_SHORT) =>
  putAccessor(document, list.map((i) => [i]), componentType, {}, INDICES);

/** POSITION, NORMAL and TEXCOORD_0 as float32. */
export const putSurface = (document, { points, normals, uvs }) => ({ POSITION: putPoints(document, points),
  NORMAL: putFloats(document, normals), TEXCOORD_0: putFloats(document, uvs) });

/** Appends a mesh. @return its index */
export const putMesh = (document, primitives, fields = {}) => document.json.meshes.push({ ...fields, primitives }) - 1;

/** Lists without elements are not legal. */
function finishJson(document, buffers) {
  const json = { ...document.json, ...(buffers.length && { buffers }) };
  return Object.fromEntries(Object.entries(json).filter(([, value]) => !(Array.isArray(value) && value.length === 0)));
}

export const chunkOf = (document) => Buffer.concat(document.chunks);

/** The bytes of a .glb; buffers after the first are `others`. */
export function toGlb(document, others = []) {
  const bin = chunkOf(document);
  const json = pad(Buffer.from(JSON.stringify(finishJson(document, [{ byteLength: bin.length }, ...others]))), 0x20);
  const words = (...values) => Buffer.from(Uint32Array.from(values).buffer);
  return Buffer.concat([words(0x46546c67, 2, 28 + json.length + bin.length),
    words(json.length, 0x4e4f534a), json, words(bin.length, 0x004e4942), bin]);
}

/** The text of a .gltf with these buffers. */
export const toGltf = (document, buffers) => Buffer.from(JSON.stringify(finishJson(document, buffers), null, 1));

export const dataUri = (bytes, type = 'application/octet-stream') =>
  `data:${type};base64,${Buffer.from(bytes).toString('base64')}`;
