// Geometry packed by Draco and by EXT_meshopt_compression. The good blobs are written here, byte by byte.
import { INDICES, POSITIONS, UINT, USHORT, addView, dataUri } from './good.mjs';

const DRACO = 'KHR_draco_mesh_compression', MESHOPT = 'EXT_meshopt_compression';

const varint = (value) => {
  const bytes = [];
  for (; value > 127; value = Math.floor(value / 128)) bytes.push((value % 128) + 128);
  return [...bytes, value];
};

/** Plain indices, as wide as the number of points needs them. */
function dracoIndices(indices, points) {
  if (points < 1 << 8) return Buffer.from(indices);
  if (points < 1 << 16) return Buffer.from(Uint16Array.from(indices).buffer);
  return points < 1 << 21 ? Buffer.from(indices.flatMap(varint)) : Buffer.from(Uint32Array.from(indices).buffer);
}

const CORNERS = [...new Uint16Array(new Uint8Array(INDICES).buffer)];

/** The octahedron as a Draco 2.2 mesh: sequential, plain indices, one attribute of plain floats. */
export function dracoBlob({ major = 2, minor = 2, kind = 1, method = 0, faces = 8, points = 6, indices = CORNERS,
  connectivity = 1, decoders = 1, attributes = 1, columns = 3, floats = POSITIONS } = {}) {
  return Buffer.concat([
    Buffer.from('DRACO'), Buffer.from([major, minor, kind, method, 0, 0]),
    Buffer.from([...varint(faces), ...varint(points), connectivity]), dracoIndices(indices, points),
    Buffer.from([decoders, ...varint(attributes), 0, 9, columns, 0, ...varint(0), 0]),
    floats,
  ]);
}

/** The octahedron with its primitive in a Draco blob. */
export const draco = (bytes, change = () => {}) => (gltf) => {
  const primitive = gltf.meshes[0].primitives[0];
  const extension = { bufferView: addView(gltf, bytes), attributes: { POSITION: 0 } };
  gltf.extensionsUsed = gltf.extensionsRequired = [DRACO];
  primitive.attributes = { POSITION: 0 };
  primitive.indices = 2;
  primitive.extensions = { [DRACO]: extension };
  for (const accessor of gltf.accessors) delete accessor.bufferView;
  change(extension, gltf);
};
const D = `#/meshes/0/primitives/0/extensions/${DRACO}`;
const noise = (count) => Buffer.from(Array.from({ length: count }, (_, i) => (i * i * 31 + i * 7 + 13) & 255));
const spoilt = (options) => [draco(dracoBlob(options)), D, '[gltf.draco]'];
const changed = (change) => draco(dracoBlob(), change);

export const dracoCases = {
  'Draco of noise': [draco(noise(500)), D, '[gltf.draco]'],
  'Draco of nothing': [draco(Buffer.alloc(0)), 'gltf.'],
  'Draco header only': [draco(dracoBlob().subarray(0, 11)), D, '[gltf.draco]'],
  'Draco of five bytes': [draco(dracoBlob().subarray(0, 5)), D, '[gltf.draco]'],
  'Draco cut in its indices': [draco(dracoBlob().subarray(0, 20)), D, '[gltf.draco]'],
  'Draco cut in its numbers': [draco(dracoBlob().subarray(0, 80)), D, '[gltf.draco]'],
  'Draco cut by a byte': [draco(dracoBlob().subarray(0, -1)), D, '[gltf.draco]'],
  'Draco of another version': spoilt({ major: 9, minor: 9 }),
  'Draco of a point cloud': spoilt({ kind: 0 }),
  'Draco of an unknown kind': spoilt({ kind: 7 }),
  'Draco of an unknown method': spoilt({ method: 9 }),
  'Draco of edgebreaker noise': [draco(Buffer.concat([Buffer.from('DRACO'), Buffer.from([2, 2, 1, 1, 0, 0, 0]), noise(300)])), D, '[gltf.draco]'],
  'Draco of four billion faces': spoilt({ faces: 4294967295 }),
  'Draco of a billion faces': spoilt({ faces: 1000000000 }),
  'Draco of four billion points': spoilt({ points: 4294967295 }),
  'Draco of a billion points': spoilt({ points: 1000000000 }),
  'Draco of a hundred million points': spoilt({ points: 100000000 }),
  'Draco of a hundred million points, as its accessor says': [draco(dracoBlob({ points: 100000000 }), (e, g) => { g.accessors[0].count = 100000000; }), 'gltf.'],
  'Draco of packed indices that are none': spoilt({ connectivity: 0 }),
  'Draco index out of range': [draco(dracoBlob({ indices: new Array(24).fill(77) })), '#/meshes/0/primitives/0/extensions/KHR_draco_mesh_compression', '[gltf.draco]'],
  'Draco without attributes': spoilt({ decoders: 0 }),
  'Draco of four billion attributes': spoilt({ attributes: 4294967295 }),
  'Draco of 255 columns': spoilt({ columns: 255 }),
  'Draco position not a number': [draco(dracoBlob({ floats: Buffer.from(new Float32Array(18).fill(NaN).buffer) })),
    '#/meshes/0/primitives/0', '[gltf.not-finite]'],
  'Draco of fewer points than its accessor': [changed((e, g) => { g.accessors[0].count = 600; }), 'gltf.'],
  'Draco of fewer faces than its accessor': [changed((e, g) => { g.accessors[2].count = 2400; }), 'gltf.'],
  'Draco of a missing view': [changed((e) => { e.bufferView = 99; }), D, 'gltf.'],
  'Draco without a view': [changed((e) => { delete e.bufferView; }), D, '[gltf.missing-field]'],
  'Draco of a missing attribute': [changed((e) => { e.attributes.POSITION = 7; }), D, '[gltf.draco]'],
  'text for a Draco attribute': [changed((e) => { e.attributes.POSITION = 'x'; }), D, '[gltf.wrong-type]'],
  'text for Draco': [changed((e, g) => { g.meshes[0].primitives[0].extensions[DRACO] = 'x'; }), D, '[gltf.wrong-type]'],
};

/** Meshopt's vertex codec, version 0, with every byte as it is: groups of 16 in mode 3. */
export function meshoptAttributes(bytes, stride) {
  const count = bytes.length / stride;
  const groups = Math.ceil(count / 16);
  const parts = [Buffer.from([0xa0])];
  for (let k = 0; k < stride; ++k) {
    const deltas = Buffer.alloc(16 * groups);
    for (let i = 0; i < count; ++i) {
      const delta = ((bytes[i * stride + k] - bytes[(i ? i - 1 : 0) * stride + k]) << 24) >> 24;
      deltas[i] = (delta << 1) ^ (delta >> 7);
    }
    parts.push(Buffer.alloc(Math.ceil(groups / 4), 0xff), deltas);
  }
  const tail = Buffer.alloc(Math.max(32, stride));
  bytes.copy(tail, tail.length - stride, 0, stride);
  return Buffer.concat([...parts, tail]);
}

/** Meshopt's codec for any sequence of indices. */
export function meshoptIndices(indices) {
  const bytes = [0xd1];
  let last = 0;
  for (const index of indices) {
    const delta = index - last;
    bytes.push(...varint((((delta << 1) ^ (delta >> 31)) << 1) >>> 0));
    last = index;
  }
  return Buffer.from([...bytes, 0, 0, 0, 0]);
}

/** The octahedron with positions and indices packed; `change` gets the two extensions and the glTF. */
export const meshopt = (change = () => {}, vertices = meshoptAttributes(POSITIONS, 12)) => (gltf) => {
  const packed = [
    [vertices, { byteStride: 12, count: 6, mode: 'ATTRIBUTES' }],
    [meshoptIndices(CORNERS), { byteStride: 2, count: 24, mode: 'INDICES' }],
  ];
  gltf.extensionsUsed = gltf.extensionsRequired = [MESHOPT];
  gltf.buffers = [{ byteLength: 120, extensions: { [MESHOPT]: { fallback: true } } }];
  const extensions = packed.map(([bytes, fields]) => {
    const buffer = gltf.buffers.push({ byteLength: bytes.length, uri: dataUri(bytes) }) - 1;
    return { buffer, byteLength: bytes.length, ...fields };
  });
  gltf.bufferViews = [
    { buffer: 0, byteLength: 72, byteStride: 12, extensions: { [MESHOPT]: extensions[0] } },
    { buffer: 0, byteOffset: 72, byteLength: 48, extensions: { [MESHOPT]: extensions[1] } },
  ];
  gltf.accessors = [gltf.accessors[0], { bufferView: 1, componentType: USHORT, count: 24, type: 'SCALAR' }];
  gltf.meshes[0].primitives[0] = { attributes: { POSITION: 0 }, indices: 1 };
  change(extensions, gltf);
};
const M = (view) => `#/bufferViews/${view}/extensions/${MESHOPT}`;
const refused = (change, code = '[gltf.meshopt]', view = 0) => [meshopt(change), M(view), code];
const OUT_OF_RANGE = '[gltf.out-of-range]';

export const meshoptCases = {
  'meshopt of a missing buffer': refused(([v]) => { v.buffer = 9; v.byteOffset = 0; v.byteLength = 0; }, '[gltf.invalid]'),
  'meshopt of more vertices': refused(([v], g) => { v.count = 6000; g.bufferViews[0].byteLength = 72000; g.buffers[0].byteLength = 72048; g.bufferViews[1].byteOffset = 72000; }),
  'meshopt of other vertices than its view': refused(([v]) => { v.count = 5; }, 'gltf.'),
  'meshopt of two billion vertices': [meshopt(([v]) => { v.count = 2 ** 31; }), 'gltf.'],
  'meshopt of four billion vertices and bytes': [meshopt(([v], g) => {
    v.count = 4294967295; g.bufferViews[0].byteLength = 4294967295; g.buffers[0].byteLength = 4294967295; g.accessors[0].count = 300000000;
  }), 'gltf.'],
  'meshopt of 2^53 vertices': refused(([v]) => { v.count = 2 ** 53; }, OUT_OF_RANGE),
  'meshopt of no vertices': refused(([v]) => { v.count = 0; }, 'gltf.'),
  'meshopt stride of 0': refused(([v]) => { v.byteStride = 0; }),
  'meshopt stride of 3': refused(([v]) => { v.byteStride = 3; v.count = 24; }),
  'meshopt stride of 257': refused(([v]) => { v.byteStride = 257; }),
  'meshopt stride of a billion': refused(([v]) => { v.byteStride = 1e9; }),
  'meshopt of an unknown mode': refused(([v]) => { v.mode = 'MAGIC'; }),
  'meshopt of no mode': refused(([v]) => { delete v.mode; }, '[gltf.missing-field]'),
  'meshopt of an unknown filter': refused(([v]) => { v.filter = 'MAGIC'; }),
  'meshopt octahedral filter of 12 bytes': refused(([v]) => { v.filter = 'OCTAHEDRAL'; }),
  'meshopt quaternion filter of 12 bytes': refused(([v]) => { v.filter = 'QUATERNION'; }),
  'meshopt filter of indices': refused(([, i]) => { i.filter = 'EXPONENTIAL'; }, '[gltf.meshopt]', 1),
  'meshopt vertices as triangles': refused(([v]) => { v.mode = 'TRIANGLES'; v.byteStride = 4; v.count = 18; }),
  'meshopt indices of 12 bytes': refused(([, i]) => { i.byteStride = 12; i.count = 4; }, '[gltf.meshopt]', 1),
  'meshopt of 23 triangle corners': refused(([, i], g) => { i.mode = 'TRIANGLES'; i.count = 23; g.bufferViews[1].byteLength = 46; }, '[gltf.meshopt]', 1),
  'meshopt sequence as triangles': refused(([, i]) => { i.mode = 'TRIANGLES'; }, '[gltf.meshopt]', 1),
  'meshopt cut short': refused(([v]) => { v.byteLength -= 1; }),
  'meshopt of one byte': refused(([v]) => { v.byteLength = 1; }),
  'meshopt beyond its buffer': refused(([v]) => { v.byteLength += 1; }, 'gltf.'),
  'meshopt at 4 GB': refused(([v]) => { v.byteOffset = 4294967292; }, 'gltf.'),
  'meshopt of a missing buffer': refused(([v]) => { v.buffer = 9; }, 'gltf.'),
  'meshopt of its own fallback': refused(([v]) => { v.buffer = 0; }, 'gltf.'),
  'plain view of a meshopt fallback': [meshopt((_, g) => { g.bufferViews.push({ buffer: 0, byteLength: 4 }); }), '#/bufferViews/2', '[gltf.invalid]'],
  'image in a meshopt fallback': [meshopt((_, g) => {
    g.bufferViews.push({ buffer: 0, byteLength: 48 });
    g.images = [{ bufferView: 2, mimeType: 'image/png' }];
  }), '#/bufferViews/2', '[gltf.invalid]'],
  'meshopt without a buffer': refused(([v]) => { delete v.buffer; }, '[gltf.missing-field]'),
  'text for meshopt': refused((_, g) => { g.bufferViews[0].extensions[MESHOPT] = 'x'; }, '[gltf.wrong-type]'),
  'meshopt of noise': [meshopt(() => {}, noise(300)), M(0), '[gltf.meshopt]'],
  'meshopt of noise with a good header': [meshopt(() => {}, Buffer.concat([Buffer.from([0xa0]), noise(300)])), 'gltf.'],
  'meshopt index out of range': [meshopt(([, i], g) => {
    const bytes = meshoptIndices([2, 4, 99999, ...new Array(21).fill(1)]);
    g.buffers[i.buffer] = { byteLength: bytes.length, uri: dataUri(bytes) };
    i.byteLength = bytes.length;
    i.byteStride = 4;
    g.bufferViews[1].byteLength = 96;
    g.buffers[0].byteLength = 168;
    g.accessors[1].componentType = UINT;
  }), '#/meshes/0/primitives/0/indices', '99999', '[gltf.accessor]'],
};

/** What must be read: else the cases above prove nothing. */
export const legal = { 'good Draco': [draco(dracoBlob())], 'good meshopt': [meshopt()] };

export const baked = { ...dracoCases, ...meshoptCases };
