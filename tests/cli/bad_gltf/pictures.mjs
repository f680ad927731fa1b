// Textures of a previewed file: made by hand, since each is wrong in one thing.
import { deflateSync } from 'node:zlib';
import { FLOAT, addAccessor, addView, set } from './good.mjs';

function pngChunk(name, bytes) {
  const chunk = Buffer.alloc(12 + bytes.length);
  chunk.writeUInt32BE(bytes.length, 0);
  chunk.write(name, 4, 'latin1');
  bytes.copy(chunk, 8);
  chunk.writeUInt32BE(checksum(chunk.subarray(4, 8 + bytes.length)), 8 + bytes.length);
  return chunk;
}

/** CRC-32: zlib shows its own only from Node 22 on. */
function checksum(bytes) {
  let crc = 0xffffffff;
  for (const byte of bytes) {
    crc ^= byte;
    for (let bit = 0; bit < 8; ++bit) crc = (crc >>> 1) ^ (crc & 1 ? 0xedb88320 : 0);
  }
  return (crc ^ 0xffffffff) >>> 0;
}

/** A PNG whose header says `width` by `height`, with `pixels` as its data. */
export function png(width, height, { depth = 8, kind = 2, pixels = deflateSync(Buffer.alloc(height * (1 + 3 * width))) } = {}) {
  const header = Buffer.alloc(13);
  header.writeUInt32BE(width >>> 0, 0);
  header.writeUInt32BE(height >>> 0, 4);
  header[8] = depth;
  header[9] = kind;
  return Buffer.concat([Buffer.from('\x89PNG\r\n\x1a\n', 'latin1'), pngChunk('IHDR', header), pngChunk('IDAT', pixels), pngChunk('IEND', Buffer.alloc(0))]);
}

/** Zeros that unpack to `size` bytes. */
const zeros = (size) => deflateSync(Buffer.alloc(size));

/** A JPEG whose frame header (`marker`) says `width` by `height`, with hardly any data. */
function jpeg(width, height, marker = 0xc0, components = 3) {
  const be16 = (value) => [value >> 8, value & 255];
  const tables = [0xff, 0xdb, ...be16(67), 0, ...new Array(64).fill(1)];
  const huffman = [0xff, 0xc4, ...be16(20), 0, 1, ...new Array(15).fill(0), 0, 0xff, 0xc4, ...be16(20), 16, 1, ...new Array(15).fill(0), 0];
  const ids = Array.from({ length: components }, (_, i) => i + 1);
  const frame = [0xff, marker, ...be16(8 + 3 * components), 8, ...be16(height), ...be16(width), components, ...ids.flatMap((id) => [id, 0x11, 0])];
  const spectrum = marker === 0xc2 ? [0, 0, 0] : [0, 63, 0];
  const scan = [0xff, 0xda, ...be16(6 + 2 * components), components, ...ids.flatMap((id) => [id, 0]), ...spectrum];
  return Buffer.from([0xff, 0xd8, ...tables, ...huffman, ...frame, ...scan, 0, 0, 0xff, 0xd9]);
}

/** The octahedron with a texture of these bytes; `change(gltf)` spoils more. */
export const textured = (bytes, change = () => {}) => (gltf) => {
  gltf.images = [{ bufferView: addView(gltf, bytes), mimeType: 'image/png' }];
  gltf.textures = [{ source: 0 }];
  gltf.materials = [{ pbrMetallicRoughness: { baseColorTexture: { index: 0 } } }];
  const primitive = gltf.meshes[0].primitives[0];
  primitive.material = 0;
  primitive.attributes.TEXCOORD_0 = addAccessor(gltf, new Float32Array(12), 'VEC2', FLOAT);
  change(gltf);
};
const I = '#/images/0', UNREADABLE = '[image.unreadable]', LARGE = '[image.too-large]';
const good = png(4, 4);

/** Without its texture a mesh is still a mesh, and is drawn so. */
export const warned = {
  'PNG of 60000 by 60000': [textured(png(60000, 60000, { pixels: zeros(1000) })), I, LARGE],
  'PNG of 4 billion by 4 billion': [textured(png(0xffffffff, 0xffffffff, { pixels: zeros(1000) })), I, LARGE],
  'PNG of 2^31 by 1': [textured(png(2 ** 31, 1, { pixels: zeros(1000) })), I, LARGE],
  'PNG of 0 by 4': [textured(png(0, 4, { pixels: zeros(4) })), I, UNREADABLE],
  'PNG of 16384 by 16384 in a few bytes': [textured(png(16384, 16384, { pixels: zeros(1000) })), I, 'image.'],
  'PNG that unpacks to 800 MB': [textured(png(16384, 16384, { kind: 2, pixels: zeros(16384 * (1 + 3 * 16384)) })), I, LARGE],
  'grey PNG that unpacks to 268 MB': [textured(png(16384, 16384, { kind: 0, pixels: zeros(16384 * (1 + 16384)) })), I, LARGE],
  'PNG of 3 bits': [textured(png(4, 4, { depth: 3 })), I, UNREADABLE],
  'PNG of an unknown kind': [textured(png(4, 4, { kind: 5 })), I, UNREADABLE],
  'PNG with palette but without one': [textured(png(4, 4, { kind: 3 })), I, UNREADABLE],
  'PNG cut off': [textured(good.subarray(0, 40)), I, UNREADABLE],
  'PNG of its signature': [textured(good.subarray(0, 8)), I, UNREADABLE],
  'PNG of noise for pixels': [textured(png(4, 4, { pixels: Buffer.alloc(60, 0x5a) })), I, UNREADABLE],
  'JPEG of three bytes': [textured(Buffer.from([0xff, 0xd8, 0xff])), I, UNREADABLE],
  'JPEG cut off': [textured(jpeg(64, 64).subarray(0, 120)), I, UNREADABLE],
  'JPEG of 65535 by 65535': [textured(jpeg(65535, 65535)), I, LARGE],
  'progressive JPEG of 16384 by 16384': [textured(jpeg(16384, 16384, 0xc2)), I, LARGE],
  'JPEG of 0 by 0': [textured(jpeg(0, 0)), I, UNREADABLE],
  'GIF for a texture': [textured(Buffer.from('GIF89a\x01\0\x01\0\0\0\0;', 'latin1')), I, UNREADABLE],
  'text for a texture': [textured(Buffer.from('<svg/>  ')), I, UNREADABLE],
};

export const previewed = {
  'image of a missing view': [textured(good, set('images.0.bufferView', 99)), '[gltf.invalid]'],
  'image beyond its buffer': [textured(good, (g) => { g.bufferViews[g.images[0].bufferView].byteLength = 1e6; }), 'gltf.'],
  'image at 4 GB': [textured(good, (g) => { g.bufferViews[g.images[0].bufferView].byteOffset = 4294967292; }), 'gltf.'],
  'image without bytes': [textured(good, set('images', [{}])), '[gltf.invalid]'],
  'texture of a missing image': [textured(good, set('textures.0.source', 44)), '#/textures/0/source', '[gltf.invalid]'],
  'material of a missing texture': [textured(good, set('materials.0.pbrMetallicRoughness.baseColorTexture.index', 44)),
    '#/materials/0/pbrMetallicRoughness/baseColorTexture/index', '[gltf.invalid]'],
  'material that is not there': [textured(good, set('meshes.0.primitives.0.material', 44)), '#/meshes/0/primitives/0/material', '[gltf.invalid]'],
  'image of bad base64': [textured(good, set('images', [{ uri: 'data:image/png;base64,????' }])), '[gltf.invalid]'],
  'missing image file': [textured(good, set('images', [{ uri: 'gone.png' }])), `${I}/uri`, '[gltf.missing-file]'],
  'fewer texture coordinates': [textured(good, (g) => {
    g.meshes[0].primitives[0].attributes.TEXCOORD_0 = addAccessor(g, new Float32Array(4), 'VEC2', FLOAT);
  }), '#/meshes/0/primitives/0/attributes/TEXCOORD_0', '[gltf.accessor]'],
  'texture coordinate not a number': [textured(good, (g) => {
    g.meshes[0].primitives[0].attributes.TEXCOORD_0 = addAccessor(g, new Float32Array(12).fill(NaN), 'VEC2', FLOAT);
  }), '#/meshes/0/primitives/0/attributes/TEXCOORD_0', '[gltf.not-finite]'],
};

export const legal = {
  'good texture': [textured(good)],
};
