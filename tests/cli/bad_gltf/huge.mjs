// Small files that ask for much: copies that multiply, lists of millions, depth.
import { FLOAT, UBYTE, USHORT, addAccessor, binChunk, container, jsonChunk } from './good.mjs';
import { draco } from './packed.mjs';

const MILLION = 1e6, BIG = 1 << 20;  // bytes of what is shared

/** The octahedron as .glb, with `size` zeros in the binary chunk as buffer 1's stead; view 3 shows them. */
const withZeros = (size, change) => (gltf) => {
  const bytes = Buffer.concat([Buffer.from(gltf.buffers[0].uri.split(',')[1], 'base64'), Buffer.alloc(size)]);
  gltf.buffers = [{ byteLength: bytes.length }];
  gltf.bufferViews.push({ buffer: 0, byteOffset: 192, byteLength: size });
  change(gltf);
  return container([jsonChunk(gltf), binChunk(bytes)]);
};

const vectors = (count) => ({ bufferView: 3, componentType: FLOAT, count, type: 'VEC3' });
const LARGE = '[gltf.too-large]';

const zeros = (type, componentType, count) => ({ componentType, count, type });

/** The octahedron's JSON with `part` `count` times in the list `kind`, without making them all first. */
const many = (kind, part, count) => (gltf) => {
  const text = JSON.stringify({ ...gltf, [kind]: ['@'] });
  const kept = (gltf[kind] ?? []).map((each) => JSON.stringify(each));
  return text.replace('"@"', [...kept, ...new Array(count).fill(JSON.stringify(part))].join());
};

const primitives = (count) => (gltf) => {
  const [primitive] = gltf.meshes[0].primitives;
  gltf.meshes[0].primitives = ['@'];
  return JSON.stringify(gltf).replace('"@"', new Array(count).fill(JSON.stringify(primitive)).join());
};

/** `count` samplers of the mesh's weights with a channel each, which read `keys` keys; of one output, or of one each. */
const samplers = (count, keys, ownOutputs = false) => (gltf) => {
  gltf.meshes[0].primitives[0].targets = [{ POSITION: 0, NORMAL: 1 }];
  const input = addAccessor(gltf, Float32Array.from({ length: keys }, (_, i) => i), 'SCALAR', FLOAT);
  const output = addAccessor(gltf, new Float32Array(keys), 'SCALAR', FLOAT);
  const list = Array.from({ length: count }, (_, i) => ({ input, output: ownOutputs ? output + i : output }));
  for (let i = 1; ownOutputs && i < count; ++i) gltf.accessors.push(gltf.accessors[output]);
  const channels = list.map((_, sampler) => ({ sampler, target: { node: 0, path: 'weights' } }));
  gltf.animations = [{ samplers: list, channels }];
};

export const baked = {
  '70 MB of text': [(g) => { g.nodes[0].name = 'data:'.repeat(1.4e7); }, LARGE],
  'a thousand pointers to the weights of two thousand nodes': [(g) => {
    g.meshes[0].primitives[0].targets = [{ POSITION: 0, NORMAL: 1 }];
    g.nodes.push(...new Array(2000).fill({ mesh: 0 }));
    const input = addAccessor(g, new Float32Array([0, 1]), 'SCALAR', FLOAT);
    const target = { path: 'pointer', extensions: { KHR_animation_pointer: { pointer: '/meshes/0/weights' } } };
    g.animations = [{ samplers: [{ input, output: input }], channels: new Array(1000).fill({ sampler: 0, target }) }];
  }, '#/animations/0/channels', LARGE],
  '170 MB of JSON': [(g) => Buffer.concat([Buffer.from(JSON.stringify(g)), Buffer.alloc(1.7e8, ' ')]), LARGE],
  '10,000 primitives': [primitives(10000), '[connectivity.different-triangles]'],
  'one megabyte of positions, 10,000 primitives': [withZeros(BIG, (g) => {
    g.accessors.push(vectors(87381));
    g.meshes[0].primitives = new Array(10000).fill({ attributes: { POSITION: 3 }, indices: 2 });
  }), LARGE],
  'one megabyte of indices, 10,000 primitives': [withZeros(BIG, (g) => {
    g.accessors.push({ bufferView: 3, componentType: USHORT, count: 524286, type: 'SCALAR' });
    g.meshes[0].primitives = new Array(10000).fill({ attributes: { POSITION: 0 }, indices: 3 });
  }), LARGE],
  'one megabyte, 10,000 targets': [withZeros(BIG, (g) => {
    g.accessors.push(vectors(87381));
    g.meshes[0].primitives = [{ attributes: { POSITION: 3 }, indices: 2, targets: new Array(10000).fill({ POSITION: 3 }) }];
  }), LARGE],
  'one megabyte, 10,000 images': [withZeros(BIG, (g) => { g.images = new Array(10000).fill({ bufferView: 3, mimeType: 'image/png' }); }), LARGE],
  'one megabyte, 1,000 curves of weights': [samplers(1000, 100000, true), '#/animations/0/samplers', LARGE],
  'a million zeros, 150 targets of normals alone': [(g) => {
    g.accessors.push(zeros('VEC3', FLOAT, MILLION));
    g.meshes[0].primitives = [{ attributes: { POSITION: 3 }, targets: new Array(150).fill({ NORMAL: 3 }) }];
  }, '#/meshes/0/primitives/0', LARGE],
  '300,000 zeros, 200 sets of joints': [(g) => {
    const [POSITION, joints, weights] = [['VEC3', FLOAT], ['VEC4', UBYTE], ['VEC4', FLOAT]].map(([type, component]) =>
      g.accessors.push(zeros(type, component, 3e5)) - 1);
    const sets = Array.from({ length: 200 }, (_, i) => [[`JOINTS_${i}`, joints], [`WEIGHTS_${i}`, weights]]).flat();
    g.meshes[0].primitives[0].attributes = { POSITION, ...Object.fromEntries(sets) };
  }, '#/meshes/0/primitives/0', LARGE],
  '100,000 names of Draco': [(g) => {
    draco(Buffer.from('no Draco'))(g);
    const names = Array.from({ length: 1e5 }, (_, i) => `_${i}`);
    const [primitive] = g.meshes[0].primitives;
    primitive.attributes = { ...Object.fromEntries(names.toReversed().map((name) => [name, 0])), POSITION: 0 };
    primitive.extensions.KHR_draco_mesh_compression.attributes = Object.fromEntries(names.map((name) => [name, 0]));
  }, '#/meshes/0/primitives/0', '[gltf.draco]'],
  'one file, 10,000 buffers': [(g) => { g.buffers.push(...new Array(10000).fill({ byteLength: BIG, uri: 'megabyte.bin' })); }, LARGE],
};

const previewTargets = withZeros(BIG, (g) => {
  g.accessors.push(vectors(87381));
  g.meshes[0].primitives = [{ attributes: { POSITION: 3 }, indices: 2, targets: new Array(10000).fill({ POSITION: 3 }) }];
});

export const previewed = {
  'one megabyte, 10,000 targets in a preview': [previewTargets, LARGE],
  'two billion zeros for keys': [(g) => {
    g.meshes[0].primitives[0].targets = [{ POSITION: 0 }];
    g.accessors.push({ componentType: FLOAT, count: 2 ** 31, type: 'SCALAR' });
    g.animations = [{ samplers: [{ input: 3, output: 3 }], channels: [{ sampler: 0, target: { node: 0, path: 'weights' } }] }];
  }, LARGE],
};

/** Legal, yet more than anybody has: they may be read, or refused as too large. */
export const legal = {
  'a million empty nodes': [many('nodes', {}, MILLION)],
  'a million empty animations': [many('animations', { samplers: [], channels: [] }, MILLION)],
  'a million accessors': [many('accessors', { bufferView: 0, componentType: FLOAT, count: 6, type: 'VEC3' }, MILLION)],
  'a million views': [many('bufferViews', { buffer: 0, byteLength: 4 }, MILLION)],
  'a million meshes': [many('meshes', { primitives: [] }, MILLION)],
  'a million materials': [many('materials', {}, MILLION)],
  'a million textures': [many('textures', {}, MILLION)],
  'a million skins': [many('skins', { joints: [0] }, MILLION)],
  'a million primitives': [primitives(MILLION)],
  'eight million zeros for positions': [(g) => { g.accessors[0] = { componentType: FLOAT, count: 2 ** 23, type: 'VEC3' }; delete g.meshes[0].primitives[0].attributes.NORMAL; }],
  'ten million numbers in extras': [(g) => JSON.stringify({ ...g, extras: ['@'] }).replace('"@"', new Array(1e7).fill(0).join())],
  '100,000 generations of nodes': [(g) => {
    g.nodes = Array.from({ length: 1e5 }, (_, i) => ({ children: [i + 1] }));
    g.nodes.push({ mesh: 0 });
  }],
  '100,000 children': [(g) => {
    g.nodes = [{ mesh: 0, children: Array.from({ length: 1e5 }, (_, i) => i + 1) }, ...new Array(1e5).fill({})];
  }],
  '100,000 meshes beside 100,000 fields': [(g) => {
    const fields = Object.fromEntries(Array.from({ length: 1e5 }, (_, i) => [`field ${i}`, 0]));
    const meshes = [...g.meshes, ...new Array(1e5).fill({ primitives: [] })];
    return JSON.stringify({ ...fields, ...g, meshes, animations: new Array(1e5).fill({ channels: [], samplers: [] }) });
  }],
  '20,000 accessors of the same numbers': [(g) => { for (let i = 0; i < 20000; ++i) g.accessors.push(g.accessors[0]); }],
  '20,000 samplers of weights': [samplers(20000, 2)],
  '1,000 samplers of one long curve': [samplers(1000, 200000)],
  '5,000 targets without normals': [(g) => { g.meshes[0].primitives[0].targets = new Array(5000).fill({ POSITION: 0 }); }],
};

/** Large, and read. */
export const read = {
  'a 64 MB binary chunk': [withZeros(64e6, () => {})],
  'a target of 100,000 attributes': [(g) => {
    const names = Array.from({ length: 1e5 }, (_, i) => [`_A${i}`, 0]);
    g.meshes[0].primitives[0].targets = [Object.fromEntries([...names, ['POSITION', 0], ['NORMAL', 1]]), { POSITION: 0 }];
  }],
  '64 MB of spaces in the JSON': [(g) => Buffer.concat([Buffer.from(`${JSON.stringify(g).slice(0, -1)}`), Buffer.alloc(64e6, ' '), Buffer.from('}')])],
  'a name of 10 MB': [(g) => { g.nodes[0].name = 'n'.repeat(1e7); }],
  '60 MB of text': [(g) => { g.extras = 't'.repeat(6e7); }],
  'a data URI of 30 MB': [(g) => {
    g.accessors.push(vectors(87381));
    addAccessor(g, new Float32Array(22.5e6 / 4), 'SCALAR', FLOAT);
    g.accessors.splice(3, 1);
  }],
};

/** The octahedron with 5000 nodes that curves of 300,000 keys move: one curve, or one each of the same numbers. */
const moved = (samplers) => (g) => {
  const input = addAccessor(g, Float32Array.from({ length: 3e5 }, (_, i) => i), 'SCALAR', FLOAT);
  const output = addAccessor(g, new Float32Array(12e5).fill(0.5), 'VEC4', FLOAT);
  g.nodes.push(...new Array(5000).fill({}));
  const channels = Array.from({ length: 5000 }, (_, i) => ({ sampler: i % samplers, target: { node: 1 + i, path: 'rotation' } }));
  g.animations = [{ samplers: new Array(samplers).fill({ input, output }), channels }];
  g.skins = [{ joints: [1] }];
  g.nodes[0].skin = 0;
};

/** Sources of which a recipe chooses a moment: legal as well. */
export const chosen = {
  'one curve for 5000 nodes': [{ animation: { time: 7 } }, moved(1)],
  '5000 curves of the same numbers': [{ animation: { time: 7 } }, moved(5000)],
};
