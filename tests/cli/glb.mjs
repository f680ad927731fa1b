// A .glb as these tests see it, by code of their own.
import { readFileSync, writeFileSync } from 'node:fs';

export function readGlb(file) {
  const bytes = readFileSync(file);
  const length = bytes.readUInt32LE(12);
  return { json: JSON.parse(bytes.toString('utf8', 20, 20 + length)), binary: Buffer.from(bytes.subarray(28 + length)) };
}

export function writeGlb(file, { json, binary }) {
  const padded = (chunk, filler) => Buffer.concat([chunk, Buffer.alloc((4 - (chunk.length % 4)) % 4, filler)]);
  const chunks = [[padded(Buffer.from(JSON.stringify(json)), ' '), 'JSON'], [padded(binary, 0), 'BIN\0']];
  const parts = chunks.flatMap(([chunk, type]) => {
    const head = Buffer.alloc(8);
    head.writeUInt32LE(chunk.length, 0);
    head.write(type, 4, 'latin1');
    return [head, chunk];
  });
  const header = Buffer.alloc(12);
  header.write('glTF', 0);
  header.writeUInt32LE(2, 4);
  header.writeUInt32LE(12 + parts.reduce((sum, part) => sum + part.length, 0), 8);
  writeFileSync(file, Buffer.concat([header, ...parts]));
}

/** The floats of a VEC3 accessor that is neither sparse nor interleaved: a view into `binary`. */
export function floatsOf({ json, binary }, index) {
  const { bufferView, byteOffset = 0, count, componentType, sparse } = json.accessors[index];
  if (componentType !== 5126 || sparse || json.bufferViews[bufferView].byteStride) throw new Error(`accessor ${index} is not plain`);
  const begin = (json.bufferViews[bufferView].byteOffset ?? 0) + byteOffset;
  return {
    length: 3 * count,
    get: (i) => binary.readFloatLE(begin + 4 * i),
    set: (i, value) => binary.writeFloatLE(value, begin + 4 * i),
  };
}
