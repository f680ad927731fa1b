// Buffers, bufferViews, accessors and the numbers in them.
import { FLOAT, UBYTE, UINT, USHORT, addAccessor, addView, all, set, withBytes } from './good.mjs';

const OUT_OF_RANGE = '[gltf.out-of-range]', ACCESSOR = '[gltf.accessor]', INVALID = '[gltf.invalid]';
const P = '#/meshes/0/primitives/0', POSITION = `${P}/attributes/POSITION`;

const buffers = {
  'huge buffer': [set('buffers.0.byteLength', 1e15), '#/buffers/0/byteLength', OUT_OF_RANGE],
  'negative buffer': [set('buffers.0.byteLength', -4), '#/buffers/0/byteLength', OUT_OF_RANGE],
  'buffer of 4 GB': [set('buffers.0.byteLength', 4294967292), '#/buffers/0', '[gltf.invalid]'],
  'buffer longer than its data': [set('buffers.0.byteLength', 196), '#/buffers/0', '[gltf.invalid]'],
  'buffer of a fraction': [set('buffers.0.byteLength', 191.5), '#/buffers/0/byteLength', '[gltf.wrong-type]'],
  'buffer without a length': [set('buffers.0.byteLength', undefined), '#/buffers/0', '[gltf.missing-field]'],
  'buffer without data': [set('buffers.0.uri', undefined), '#/buffers/0', '[gltf.invalid]'],
  'negative view offset': [set('bufferViews.1.byteOffset', -4), '#/bufferViews/1/byteOffset', OUT_OF_RANGE],
  'view beyond its buffer': [set('bufferViews.0.byteLength', 720000), '#/bufferViews/0', '[gltf.invalid]'],
  'view that starts beyond its buffer': [set('bufferViews.0.byteOffset', 200), '#/bufferViews/0', '[gltf.invalid]'],
  'view whose end overflows 32 bits': [all(set('bufferViews.0.byteOffset', 4294967292), set('bufferViews.0.byteLength', 4294967292)),
    '#/bufferViews/0', '[gltf.invalid]'],
  'view whose end overflows 64 bits': [set('bufferViews.0.byteOffset', 18446744073709551000), '#/bufferViews/0/byteOffset', OUT_OF_RANGE],
  'view of no bytes': [set('bufferViews.0.byteLength', 0), 'gltf.'],
  'view without a buffer': [set('bufferViews.0.buffer', undefined), '#/bufferViews/0', '[gltf.missing-field]'],
  'view of a missing buffer': [set('bufferViews.0.buffer', 7), '#/bufferViews/0/buffer', '[gltf.invalid]'],
  'unused view of a missing buffer': [(g) => { g.bufferViews.push({ buffer: 3, byteLength: 48 }); }, '#/bufferViews/3/buffer', '[gltf.invalid]'],
  'unused view beyond its buffer': [(g) => { g.bufferViews.push({ buffer: 0, byteOffset: 190, byteLength: 48 }); }, '#/bufferViews/3', '[gltf.invalid]'],
  'view of buffer -1': [set('bufferViews.0.buffer', -1), '#/bufferViews/0/buffer', OUT_OF_RANGE],
  'stride of zero': [set('bufferViews.0.byteStride', 0), '#/bufferViews/0/byteStride', OUT_OF_RANGE],
  'stride of one': [set('bufferViews.0.byteStride', 1), '#/bufferViews/0/byteStride', OUT_OF_RANGE],
  'stride of five': [set('bufferViews.0.byteStride', 5), '[gltf.invalid]'],
  'stride of 252': [set('bufferViews.0.byteStride', 252), '/accessors/0', ACCESSOR],
  'stride of 256': [set('bufferViews.0.byteStride', 256), '#/bufferViews/0/byteStride', OUT_OF_RANGE],
  'stride of four billion': [set('bufferViews.0.byteStride', 4294967295), '#/bufferViews/0/byteStride', OUT_OF_RANGE],
};

const accessors = {
  'negative accessor offset': [set('accessors.0.byteOffset', -4), '#/accessors/0/byteOffset', OUT_OF_RANGE],
  'accessor offset of 4 GB': [set('accessors.0.byteOffset', 4294967292), '/accessors/0', ACCESSOR],
  'accessor offset of 2^64': [set('accessors.0.byteOffset', 18446744073709552000), '#/accessors/0/byteOffset', OUT_OF_RANGE],
  'no elements': [set('accessors.0.count', 0), '#/accessors/0/count', OUT_OF_RANGE],
  'one element too many': [set('accessors.0.count', 7), '/accessors/0', ACCESSOR],
  'two billion elements': [set('accessors.0.count', 2 ** 31), P, '[gltf.too-large]'],
  'four billion elements': [set('accessors.0.count', 4294967295), P, '[gltf.too-large]'],
  'elements that overflow 32 bits': [set('accessors.0.count', 357913942), P, '[gltf.too-large]'],
  '2^32 elements': [set('accessors.0.count', 2 ** 32), '#/accessors/0/count', OUT_OF_RANGE],
  '2^53 elements': [set('accessors.0.count', 2 ** 53), '#/accessors/0/count', OUT_OF_RANGE],
  '2^64 elements': [set('accessors.0.count', 2 ** 64), '#/accessors/0/count', OUT_OF_RANGE],
  '1e300 elements': [set('accessors.0.count', 1e300), '#/accessors/0/count', 'gltf.'],
  '-1 elements': [set('accessors.0.count', -1), '#/accessors/0/count', OUT_OF_RANGE],
  'half an element': [set('accessors.0.count', 5.5), '#/accessors/0/count', '[gltf.wrong-type]'],
  'text for a count': [set('accessors.0.count', '6'), '#/accessors/0/count', '[gltf.wrong-type]'],
  'unknown component type': [set('accessors.0.componentType', 9), '#/accessors/0/componentType', '[gltf.wrong-type]'],
  'doubles': [set('accessors.0.componentType', 5130), '#/accessors/0/componentType', '[gltf.wrong-type]'],
  'unknown element type': [set('accessors.0.type', 'VEC9'), '#/accessors/0/type', '[gltf.bad-value]'],
  'accessor without a type': [set('accessors.0.type', undefined), '#/accessors/0', '[gltf.missing-field]'],
  'fewer texture coordinates than positions': [(g) => {
    g.meshes[0].primitives[0].attributes.TEXCOORD_0 = addAccessor(g, new Float32Array(4), 'VEC2', FLOAT);
  }, '#/meshes/0/primitives/0/attributes/TEXCOORD_0', ACCESSOR],
  'missing accessor': [set('meshes.0.primitives.0.attributes.POSITION', 77), POSITION, INVALID],
  'accessor -1': [set('meshes.0.primitives.0.attributes.POSITION', -1), POSITION, OUT_OF_RANGE],
  'accessor of four billion': [set('meshes.0.primitives.0.attributes.POSITION', 4294967295), POSITION, INVALID],
  'accessor of a half': [set('meshes.0.primitives.0.attributes.POSITION', 0.5), POSITION, '[gltf.wrong-type]'],
  'missing view': [set('accessors.0.bufferView', 9), '/accessors/0', INVALID],
  'view -1': [set('accessors.0.bufferView', -1), '#/accessors/0/bufferView', OUT_OF_RANGE],
  'text for a minimum': [set('accessors.0.min', 'x'), '#/accessors/0/min', '[gltf.wrong-type]'],
  'two billion zeros': [(g) => { g.accessors[0] = { componentType: FLOAT, count: 2 ** 31, type: 'VEC3' }; }, '[gltf.too-large]'],
  'four billion zeros for indices': [(g) => { g.accessors[2] = { componentType: UINT, count: 4294967295, type: 'SCALAR' }; }, P, '[gltf.too-large]'],
  'positions of two numbers': [set('accessors.0.type', 'VEC2'), POSITION, ACCESSOR],
  'positions of matrices': [(g) => { g.meshes[0].primitives[0].attributes.POSITION = addAccessor(g, new Float32Array(96), 'MAT4', FLOAT); }, POSITION, ACCESSOR],
  'positions of 32-bit integers': [set('accessors.0.componentType', UINT), POSITION, 'gltf.'],
  'fewer normals': [set('accessors.1.count', 5), `${P}/attributes/NORMAL`, ACCESSOR],
};

/** The good positions with a sparse part, changed by `change(sparse)`. */
const sparse = (change, indices = Uint16Array.of(1, 3)) => (gltf) => {
  const part = {
    count: indices.length,
    indices: { bufferView: addView(gltf, Buffer.from(indices.buffer)), componentType: USHORT },
    values: { bufferView: addView(gltf, Buffer.alloc(12 * indices.length)) },
  };
  gltf.accessors[0].sparse = part;
  change(part, gltf);
};
const S = '#/accessors/0/sparse';
const same = () => {};

const sparseCases = {
  'sparse index out of range': [sparse(same, Uint16Array.of(1, 6)), S, ACCESSOR],
  'sparse indices that fall': [sparse(same, Uint16Array.of(3, 1)), S, ACCESSOR],
  'sparse indices that repeat': [sparse(same, Uint16Array.of(3, 3)), S, ACCESSOR],
  'more sparse elements than the base': [sparse(same, Uint16Array.of(0, 1, 2, 3, 4, 5, 6)), S, ACCESSOR],
  'sparse count of four billion': [sparse((s) => { s.count = 4294967295; }), S, 'gltf.'],
  'sparse count of 2^53': [sparse((s) => { s.count = 2 ** 53; }), S, OUT_OF_RANGE],
  'sparse count of 0': [sparse((s) => { s.count = 0; }), S, OUT_OF_RANGE],
  'sparse count of -1': [sparse((s) => { s.count = -1; }), S, OUT_OF_RANGE],
  'sparse indices beyond their view': [sparse((s) => { s.indices.byteOffset = 2; }), S, ACCESSOR],
  'sparse indices at 4 GB': [sparse((s) => { s.indices.byteOffset = 4294967292; }), S, ACCESSOR],
  'sparse values beyond their view': [sparse((s) => { s.values.byteOffset = 12; }), S, ACCESSOR],
  'sparse values at 4 GB': [sparse((s) => { s.values.byteOffset = 4294967292; }), S, ACCESSOR],
  'sparse indices of floats': [sparse((s) => { s.indices.componentType = FLOAT; }), S, '[gltf.wrong-type]'],
  'sparse indices without a view': [sparse((s) => { delete s.indices.bufferView; }), S, '[gltf.missing-field]'],
  'sparse without values': [sparse((s) => { delete s.values; }), S, '[gltf.missing-field]'],
  'sparse of a missing view': [sparse((s) => { s.values.bufferView = 99; }), '#/accessors/0/sparse/values/bufferView', INVALID],
  'text for sparse': [set('accessors.0.sparse', 'x'), S, '[gltf.wrong-type]'],
  'sparse over two billion zeros': [sparse((s, g) => { delete g.accessors[0].bufferView; g.accessors[0].count = 2 ** 31; }), '[gltf.too-large]'],
  'sparse value not a number': [(g) => {
    sparse(same)(g);
    g.accessors[0].sparse.values.bufferView = addView(g, Buffer.from(Float32Array.of(NaN, 0, 0, 0, 0, 0).buffer));
  }, POSITION, '[gltf.not-finite]'],
};

const indices = {
  'index out of range': [withBytes((_, i) => { i[5] = 999; }), `${P}/indices`, '999', ACCESSOR],
  'index that restarts': [withBytes((_, i) => { i[5] = 65535; }), `${P}/indices`, ACCESSOR],
  'missing index accessor': [set('meshes.0.primitives.0.indices', 50), `${P}/indices`, INVALID],
  'index accessor of four billion': [set('meshes.0.primitives.0.indices', 4294967295), `${P}/indices`, INVALID],
  'indices of floats': [set('accessors.2.componentType', FLOAT), 'gltf.'],
  'indices of vectors': [all(set('accessors.2.type', 'VEC3'), set('accessors.2.count', 8)), `${P}/indices`, ACCESSOR],
  'indices of signed bytes': [set('accessors.2.componentType', 5120), `${P}/indices`, ACCESSOR],
  '23 indices': [set('accessors.2.count', 23), P, ACCESSOR],
  'indices of bytes that are shorts': [(g) => { Object.assign(g.accessors[2], { componentType: UBYTE, count: 48 }); }, 'connectivity.'],
};

const numbers = {
  'position not a number': [withBytes((floats) => { floats[4] = NaN; }), POSITION, '[gltf.not-finite]'],
  'infinite position': [withBytes((floats) => { floats[17] = -Infinity; }), POSITION, '[gltf.not-finite]'],
  'infinite normal': [withBytes((floats) => { floats[20] = Infinity; }), `${P}/attributes/NORMAL`, '[gltf.not-finite]'],
  'denormal positions': [withBytes((floats) => { floats.subarray(0, 18).forEach((x, i) => { floats[i] = x * 1e-44; }); }), '[gltf.extreme-size]'],
  'all indices zero': [withBytes((_, i) => { i.fill(0); }), '[connectivity.'],
  'other triangle count': [set('accessors.2.count', 21), '[connectivity.different-triangles]'],
  'other topology': [withBytes((_, i) => { i.set([2, 0, 4], 0); i.set([2, 4, 1], 9); i.set([2, 5, 1], 3); }),
    '[connectivity.different-topology]'],
  'non-manifold': [withBytes((_, i) => { i.set([2, 4, 1], 0); }), 'connectivity.'],
};

export const baked = { ...buffers, ...accessors, ...sparseCases, ...indices, ...numbers };

/** Shapes that are odd, and yet are shapes. */
export const legal = {
  'all positions at one point': [withBytes((floats) => { floats.fill(0.5, 0, 18); })],
  'astronomic positions': [withBytes((floats) => { floats.subarray(0, 18).forEach((x, i) => { floats[i] = x * 3e38; }); })],
};
