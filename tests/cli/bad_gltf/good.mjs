// A good glTF and what the bad ones are made of it with.

const POINTS = [[1, 0, 0], [-1, 0, 0], [0, 1, 0], [0, -1, 0], [0, 0, 1], [0, 0, -1]];
const FACES = [[2, 4, 0], [2, 0, 5], [2, 5, 1], [2, 1, 4], [3, 0, 4], [3, 5, 0], [3, 1, 5], [3, 4, 1]];
export const POSITIONS = Buffer.from(new Float32Array(POINTS.flat()).buffer);
export const INDICES = Buffer.from(new Uint16Array(FACES.flat()).buffer);
export const FLOAT = 5126, USHORT = 5123, UINT = 5125, UBYTE = 5121;

export const dataUri = (bytes, type = 'application/octet-stream') => `data:${type};base64,${bytes.toString('base64')}`;

/** An octahedron as glTF JSON with one data URI: positions, normals, indices. */
export function octahedron() {
  const bytes = Buffer.concat([POSITIONS, POSITIONS, INDICES]);
  return {
    asset: { version: '2.0' },
    scene: 0,
    scenes: [{ nodes: [0] }],
    nodes: [{ mesh: 0 }],
    meshes: [{ primitives: [{ attributes: { POSITION: 0, NORMAL: 1 }, indices: 2 }] }],
    accessors: [
      { bufferView: 0, componentType: FLOAT, count: 6, type: 'VEC3', min: [-1, -1, -1], max: [1, 1, 1] },
      { bufferView: 1, componentType: FLOAT, count: 6, type: 'VEC3' },
      { bufferView: 2, componentType: USHORT, count: 24, type: 'SCALAR' },
    ],
    bufferViews: [
      { buffer: 0, byteOffset: 0, byteLength: 72 },
      { buffer: 0, byteOffset: 72, byteLength: 72 },
      { buffer: 0, byteOffset: 144, byteLength: 48 },
    ],
    buffers: [{ byteLength: bytes.length, uri: dataUri(bytes) }],
  };
}

/** The octahedron's bytes after `change(floats, indices)`. */
export const withBytes = (change) => (gltf) => {
  const copy = new Uint8Array(Buffer.from(gltf.buffers[0].uri.split(',')[1], 'base64'));
  change(new Float32Array(copy.buffer, 0, 36), new Uint16Array(copy.buffer, 144, 24));
  gltf.buffers[0].uri = dataUri(Buffer.from(copy));
};

/** Puts `value` at a place such as 'nodes.0.mesh'; undefined removes it. */
export const set = (path, value) => (gltf) => {
  const keys = path.split('.');
  const last = keys.pop();
  const parent = keys.reduce((at, key) => at[key], gltf);
  if (value === undefined) delete parent[last];
  else parent[last] = value;
};

/** Several changes, one after the other. */
export const all = (...changes) => (gltf) => { for (const change of changes) change(gltf); };

/** Appends `bytes` as a buffer and a bufferView of their own; the view's index. */
export function addView(gltf, bytes) {
  gltf.buffers.push({ byteLength: bytes.length, uri: dataUri(bytes) });
  return gltf.bufferViews.push({ buffer: gltf.buffers.length - 1, byteLength: bytes.length }) - 1;
}

/** Appends an accessor of a typed array; its index. */
export function addAccessor(gltf, values, type, componentType, columns = { SCALAR: 1, VEC2: 2, VEC3: 3, VEC4: 4, MAT4: 16 }[type]) {
  const bufferView = addView(gltf, Buffer.from(values.buffer));
  return gltf.accessors.push({ bufferView, componentType, count: values.length / columns, type }) - 1;
}

/** A .glb of `chunks`: [type, bytes, length that is claimed]. */
export function container(chunks, { version = 2, length } = {}) {
  const parts = chunks.map(([type, bytes, claimed = bytes.length]) => {
    const head = Buffer.alloc(8);
    head.writeUInt32LE(claimed, 0);
    head.write(type, 4, 'latin1');
    return Buffer.concat([head, bytes]);
  });
  const body = Buffer.concat(parts);
  const header = Buffer.alloc(12);
  header.write('glTF', 0, 'latin1');
  header.writeUInt32LE(version, 4);
  header.writeUInt32LE(length ?? 12 + body.length, 8);
  return Buffer.concat([header, body]);
}

const padded = (bytes, fill) => Buffer.concat([bytes, Buffer.alloc((4 - (bytes.length % 4)) % 4, fill)]);

export const jsonChunk = (gltf) => ['JSON', padded(Buffer.from(JSON.stringify(gltf)), ' ')];
export const binChunk = (bytes) => ['BIN\0', padded(bytes, 0)];

/** The octahedron as a .glb with its bytes in the binary chunk, after `change(gltf)`. */
export function binaryOctahedron(gltf) {
  const bytes = Buffer.from(gltf.buffers[0].uri.split(',')[1], 'base64');
  delete gltf.buffers[0].uri;
  return { json: jsonChunk(gltf), bin: binChunk(bytes) };
}
