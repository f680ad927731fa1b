// Bad glTF sources, each made here by one change to a good file, and what must be told of them.
//
//   node bad_gltf.mjs MORPHBAKE SCRATCH
//
// Every case must end with exit code 4, name the file and the place, and leave no output behind.
import { spawnSync } from 'node:child_process';
import { mkdirSync, readdirSync, rmSync, symlinkSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';

const [program, scratch] = process.argv.slice(2);

/** An octahedron as glTF JSON with one data URI: positions, normals, indices. */
function octahedron() {
  const points = [[1, 0, 0], [-1, 0, 0], [0, 1, 0], [0, -1, 0], [0, 0, 1], [0, 0, -1]];
  const faces = [[2, 4, 0], [2, 0, 5], [2, 5, 1], [2, 1, 4], [3, 0, 4], [3, 5, 0], [3, 1, 5], [3, 4, 1]];
  const floats = Buffer.from(new Float32Array([...points.flat(), ...points.flat()]).buffer);
  const indices = Buffer.from(new Uint16Array(faces.flat()).buffer);
  const bytes = Buffer.concat([floats, indices]);
  return {
    asset: { version: '2.0' },
    scene: 0,
    scenes: [{ nodes: [0] }],
    nodes: [{ mesh: 0 }],
    meshes: [{ primitives: [{ attributes: { POSITION: 0, NORMAL: 1 }, indices: 2 }] }],
    accessors: [
      { bufferView: 0, componentType: 5126, count: 6, type: 'VEC3', min: [-1, -1, -1], max: [1, 1, 1] },
      { bufferView: 1, componentType: 5126, count: 6, type: 'VEC3' },
      { bufferView: 2, componentType: 5123, count: 24, type: 'SCALAR' },
    ],
    bufferViews: [
      { buffer: 0, byteOffset: 0, byteLength: 72 },
      { buffer: 0, byteOffset: 72, byteLength: 72 },
      { buffer: 0, byteOffset: 144, byteLength: 48 },
    ],
    buffers: [{ byteLength: bytes.length, uri: dataUri(bytes) }],
  };
}

const dataUri = (bytes) => `data:application/octet-stream;base64,${bytes.toString('base64')}`;

/** The octahedron's bytes after `change(floats, indices)`. */
function withBytes(change) {
  return (gltf) => {
    const bytes = Buffer.from(gltf.buffers[0].uri.split(',')[1], 'base64');
    const copy = new Uint8Array(bytes);
    change(new Float32Array(copy.buffer, 0, 36), new Uint16Array(copy.buffer, 144, 24));
    gltf.buffers[0].uri = dataUri(Buffer.from(copy));
  };
}

function glb(gltf, { version = 2, length = 0, chunk = 'JSON' } = {}) {
  const text = JSON.stringify(gltf);
  const json = Buffer.from(text.padEnd(Math.ceil(text.length / 4) * 4));
  const header = Buffer.alloc(20);
  header.write('glTF', 0, 'latin1');
  header.writeUInt32LE(version, 4);
  header.writeUInt32LE(length || 20 + json.length, 8);
  header.writeUInt32LE(json.length, 12);
  header.write(chunk, 16, 'latin1');
  return Buffer.concat([header, json]);
}

const set = (path, value) => (gltf) => {
  const keys = path.split('.');
  const last = keys.pop();
  const parent = keys.reduce((at, key) => at[key], gltf);
  if (value === undefined) delete parent[last];
  else parent[last] = value;
};

// name: [change of the good glTF or the file's bytes, what stderr must say ...]
const cases = {
  'text file': [() => 'solid cube\nendsolid', '[gltf.not-gltf]', 'glTF 2.0'],
  'empty file': [() => '', '[gltf.not-gltf]'],
  'broken JSON': [() => '{"asset": {"version": "2.0"}', '[gltf.json-syntax]'],
  'other JSON': [() => '{"name": "x"}', '#/asset/version', '[gltf.not-gltf]'],
  'glTF 1': [set('asset.version', '1.0'), '#/asset/version', '[gltf.version]', '"1.0"'],
  'glb of container version 1': [(g) => glb(g, { version: 1 }), '[gltf.version]'],
  'glb cut off': [(g) => glb(g).subarray(0, 300), '[gltf.truncated]'],
  'glb of eight bytes': [(g) => glb(g).subarray(0, 8), '[gltf.truncated]'],
  'glb without JSON': [(g) => glb(g, { chunk: 'BIN\0' }), '[gltf.truncated]'],
  'required extension': [set('extensionsRequired', ['KHR_draco_mesh_compression']),
    '#/extensionsRequired/0', 'KHR_draco_mesh_compression', '[gltf.unsupported-extension]'],
  'buffer outside the folder': [set('buffers.0.uri', '../../../../etc/passwd'),
    '#/buffers/0/uri', '[gltf.outside-folder]'],
  'escaped way out': [set('buffers.0.uri', '%2e%2e/secret.bin'), '#/buffers/0/uri', '[gltf.outside-folder]'],
  'absolute buffer': [set('buffers.0.uri', '/etc/passwd'), '#/buffers/0/uri', '[gltf.outside-folder]'],
  'buffer of the web': [set('buffers.0.uri', 'https://example.org/a.bin'), '[gltf.outside-folder]'],
  'link out of the folder': [set('buffers.0.uri', 'link.bin'), '#/buffers/0/uri', '[gltf.outside-folder]'],
  'image outside the folder': [set('images', [{ uri: '../secret.png' }]), '#/images/0/uri', '[gltf.outside-folder]'],
  'missing buffer': [set('buffers.0.uri', 'gone.bin'), '#/buffers/0/uri', '"gone.bin"', '[gltf.missing-file]'],
  'huge buffer': [set('buffers.0.byteLength', 1e15), '#/buffers/0/byteLength', '[gltf.out-of-range]'],
  'negative buffer': [set('buffers.0.byteLength', -4), '#/buffers/0/byteLength', '[gltf.out-of-range]'],
  'negative view offset': [set('bufferViews.1.byteOffset', -4), '#/bufferViews/1/byteOffset', '[gltf.out-of-range]'],
  'negative accessor offset': [set('accessors.0.byteOffset', -4), '#/accessors/0/byteOffset', '[gltf.out-of-range]'],
  'stride of one': [set('bufferViews.0.byteStride', 1), '#/bufferViews/0/byteStride', '[gltf.out-of-range]'],
  'no elements': [set('accessors.0.count', 0), '#/accessors/0/count', '[gltf.out-of-range]'],
  'unknown component type': [set('accessors.0.componentType', 9), '#/accessors/0/componentType', '[gltf.wrong-type]'],
  'accessor without a type': [set('accessors.0.type', undefined), '#/accessors/0', '[gltf.missing-field]'],
  'text for targets': [set('meshes.0.primitives.0.targets', 'x'), '#/meshes/0/primitives/0/targets', '[gltf.wrong-type]'],
  'text for a mode': [set('meshes.0.primitives.0.mode', '4'), '#/meshes/0/primitives/0/mode', '[gltf.wrong-type]'],
  'number for a mesh': [set('meshes.0', 3), '#/meshes/0', '[gltf.wrong-type]'],
  'matrix of 15': [set('nodes.0.matrix', new Array(15).fill(1)), '#/nodes/0/matrix', '[gltf.bad-value]'],
  'scale of 2': [set('nodes.0.scale', [1, 1]), '#/nodes/0/scale', '[gltf.bad-value]'],
  'astronomic scale': [set('nodes.0.scale', [1e200, 1e200, 1e200]), '#/nodes/0', '[gltf.extreme-size]'],
  'view beyond its buffer': [set('bufferViews.0.byteLength', 720000), '/accessors/0', '[gltf.accessor]'],
  'accessor beyond its view': [set('accessors.0.count', 4000000000), '/accessors/0', '[gltf.accessor]'],
  'missing accessor': [set('meshes.0.primitives.0.attributes.POSITION', 77),
    '#/meshes/0/primitives/0/attributes/POSITION', '[gltf.accessor]'],
  'missing view': [set('accessors.0.bufferView', 9), '/accessors/0', '[gltf.accessor]'],
  'index out of range': [withBytes((_, indices) => { indices[5] = 999; }),
    '#/meshes/0/primitives/0/indices', '999', '[gltf.accessor]'],
  'position not a number': [withBytes((floats) => { floats[4] = NaN; }),
    '#/meshes/0/primitives/0/attributes/POSITION', '[gltf.not-finite]'],
  'infinite normal': [withBytes((floats) => { floats[20] = Infinity; }),
    '#/meshes/0/primitives/0/attributes/NORMAL', '[gltf.not-finite]'],
  'quantised positions': [set('accessors.0.componentType', 5122), '/attributes/POSITION', '[gltf.unsupported-accessor]'],
  'sparse positions': [set('accessors.0.sparse', { count: 1, indices: { bufferView: 2, componentType: 5123 }, values: { bufferView: 0 } }),
    '/accessors/0', '[gltf.unsupported-accessor]'],
  'triangle strip': [set('meshes.0.primitives.0.mode', 5), '#/meshes/0/primitives/0/mode', '[gltf.unsupported-primitive]'],
  'no indices': [set('meshes.0.primitives.0.indices', undefined), '#/meshes/0/primitives/0', '[gltf.unsupported-primitive]'],
  'no positions': [set('meshes.0.primitives.0.attributes', { NORMAL: 1 }), 'POSITION', '[gltf.unsupported-primitive]'],
  'morph targets': [set('meshes.0.primitives.0.targets', [{ POSITION: 0 }]), '#/meshes/0/primitives/0/targets', '[gltf.unsupported-targets]'],
  'no mesh': [set('nodes.0.mesh', undefined), '[gltf.no-mesh]'],
  'node without its mesh': [set('nodes.0.mesh', 3), '#/nodes/0/mesh', '[gltf.invalid]'],
  'two mesh nodes': [(g) => { g.nodes.push({ mesh: 0 }); g.scenes[0].nodes.push(1); }, '#/nodes/1', '[gltf.several-meshes]'],
  'node cycle': [(g) => { g.nodes = [{ children: [1] }, { children: [0], mesh: 0 }]; }, '/nodes/0', '[gltf.invalid]'],
  'flattening node': [set('nodes.0.scale', [1, 0, 1]), '#/nodes/0', '[gltf.singular-transform]'],
  'skin': [(g) => { g.nodes = [{ mesh: 0, skin: 0 }, {}]; g.skins = [{ joints: [1] }]; }, '#/nodes/0/skin', '[gltf.unsupported-skin]'],
  'other triangle count': [set('accessors.2.count', 21), '[connectivity.different-triangles]'],
  'other topology': [withBytes((_, indices) => { indices.set([2, 0, 4], 0); indices.set([2, 4, 1], 9); indices.set([2, 5, 1], 3); }),
    '[connectivity.different-topology]'],
  'non-manifold': [withBytes((_, indices) => { indices.set([2, 4, 1], 0); }), 'connectivity.'],
};

function makeFile(change) {
  const gltf = octahedron();
  const made = change(gltf);
  return typeof made === 'string' || Buffer.isBuffer(made) ? made : JSON.stringify(gltf);
}

function filesBelow(folder) {
  return readdirSync(folder, { recursive: true, withFileTypes: true }).filter((entry) => !entry.isDirectory());
}

/** Problems of one case: [] when all is as it must be. */
function run(name, [change, ...texts]) {
  const folder = join(scratch, name.replaceAll(' ', '-'), 'recipe');
  rmSync(folder, { recursive: true, force: true });
  mkdirSync(folder, { recursive: true });
  writeFileSync(join(folder, '..', 'secret.bin'), Buffer.alloc(192));
  writeFileSync(join(folder, '..', 'secret.png'), 'no picture');
  symlinkSync(join(folder, '..', 'secret.bin'), join(folder, 'link.bin'));
  writeFileSync(join(folder, 'good.gltf'), JSON.stringify(octahedron()));
  writeFileSync(join(folder, 'bad.gltf'), makeFile(change));
  writeFileSync(join(folder, 'recipe.json'), JSON.stringify({
    version: 1, name: 'bad', sources: { good: 'good.gltf', bad: 'bad.gltf' },
    timeline: { tracks: [{ name: 'all', to: 'bad', begin: 0, end: 1 }] },
    outputs: [{ file: 'out/bad.glb' }],
  }));
  const before = filesBelow(folder).length;
  const done = spawnSync(program, ['bake', join(folder, 'recipe.json')], { encoding: 'utf8', timeout: 60000 });
  const problems = texts.concat('bad.gltf').filter((text) => !done.stderr.includes(text))
    .map((text) => `stderr does not say ${JSON.stringify(text)}`);
  if (done.status !== 4) problems.push(`exit code ${done.status ?? done.signal} instead of 4`);
  // Sources that are not connected alike leave a picture of it (mismatch.mjs); nothing else may appear.
  const left = filesBelow(folder).filter((file) => !file.name.endsWith('.mismatch.png'));
  if (left.length !== before) problems.push('something was left behind');
  return problems.length ? [...problems, done.stderr.trim()] : [];
}

rmSync(scratch, { recursive: true, force: true });
let failed = 0;
for (const [name, definition] of Object.entries(cases)) {
  const problems = run(name, definition);
  console.log(`${problems.length ? 'FAILED' : 'ok    '} ${name}`);
  for (const problem of problems) console.log(`       ${problem}`);
  failed += problems.length > 0;
}
console.log(`${Object.keys(cases).length - failed} passed, ${failed} failed`);
process.exit(failed ? 1 : 0);
