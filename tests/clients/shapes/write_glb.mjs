// Writes small .glb files for the tests; only what they need.

const FLOAT = 5126;
const UNSIGNED_SHORT = 5123;
const TYPES = { 1: 'SCALAR', 2: 'VEC2', 3: 'VEC3', 4: 'VEC4' };

/** An accessor to write: rows of numbers as float32, or indices as uint16. */
export const floats = (rows, width, target = 34962) => ({ values: Float32Array.from(rows.flat()), width, target, componentType: FLOAT });
export const indices = (list) => ({ values: Uint16Array.from(list), width: 1, target: 34963, componentType: UNSIGNED_SHORT });

/**
 * Packs glTF JSON in which accessors are still arrays (from floats() and indices()).
 *
 * @param accessors  in the order in which the JSON counts them
 * @return the file's bytes
 */
export function packGlb(json, accessors) {
  const chunks = [];
  const complete = { asset: { version: '2.0' }, ...json, accessors: [], bufferViews: [] };
  let offset = 0;
  for (const accessor of accessors) {
    const bytes = Buffer.from(accessor.values.buffer);
    complete.bufferViews.push({ buffer: 0, byteOffset: offset, byteLength: bytes.length,
      ...(accessor.target && { target: accessor.target }) });
    complete.accessors.push(describeAccessor(accessor, complete.bufferViews.length - 1));
    chunks.push(pad(bytes, 0));
    offset += chunks.at(-1).length;
  }
  complete.buffers = [{ byteLength: offset }];
  return packChunks(complete, Buffer.concat(chunks));
}

function describeAccessor({ values, width, componentType }, bufferView) {
  const count = values.length / width;
  const column = (k) => Array.from({ length: count }, (_, i) => values[i * width + k]);
  const columns = Array.from({ length: width }, (_, k) => column(k));
  return { bufferView, componentType, type: TYPES[width], count,
    min: columns.map((c) => Math.min(...c)), max: columns.map((c) => Math.max(...c)) };
}

const pad = (bytes, filler) => Buffer.concat([bytes, Buffer.alloc(-bytes.length & 3, filler)]);

/** The file's bytes. @param binary  its buffer, a multiple of four bytes long */
export const packChunks = (json, binary) => joinChunks(pad(Buffer.from(JSON.stringify(json)), 0x20), binary);

function joinChunks(json, bin) {
  const words = (...values) => Buffer.from(Uint32Array.from(values).buffer);
  return Buffer.concat([words(0x46546c67, 2, 28 + json.length + bin.length),
    words(json.length, 0x4e4f534a), json, words(bin.length, 0x004e4942), bin]);
}
