// Small pictures for textures.
import { crc32, deflateSync } from 'node:zlib';

function chunk(name, data) {
  const body = Buffer.concat([Buffer.from(name, 'latin1'), data]);
  const [length, sum] = [Buffer.alloc(4), Buffer.alloc(4)];
  length.writeUInt32BE(data.length);
  sum.writeUInt32BE(crc32(body));
  return Buffer.concat([length, body, sum]);
}

/** A PNG of `size` by `size` checks in two colours ([r, g, b], 0..255). */
export function drawChecks(size, light, dark) {
  const header = Buffer.alloc(13);
  header.writeUInt32BE(size, 0), header.writeUInt32BE(size, 4), header.set([8, 2, 0, 0, 0], 8);
  const rows = Array.from({ length: size }, (_, y) =>
    Buffer.from([0, ...Array.from({ length: size }, (__, x) => ((x >> 2) + (y >> 2)) % 2 ? dark : light).flat()]));
  return Buffer.concat([Buffer.from([0x89, 0x50, 0x4e, 0x47, 0x0d, 0x0a, 0x1a, 0x0a]), chunk('IHDR', header),
    chunk('IDAT', deflateSync(Buffer.concat(rows))), chunk('IEND', Buffer.alloc(0))]);
}

/** Numbers of some bits each, the lowest bit first. */
function packBits(fields) {
  const bits = fields.flatMap(([value, count]) => Array.from({ length: count }, (_, i) => (value >> i) & 1));
  const bytes = Buffer.alloc(Math.ceil(bits.length / 8));
  bits.forEach((bit, i) => { bytes[i >> 3] |= bit << (i & 7); });
  return bytes;
}

/** A WebP of `size` by `size` pixels of one colour: lossless, all five codes (green, red, blue, alpha, distance) of one symbol. */
export function drawWebp(size, [red, green, blue]) {
  const byteCode = (symbol) => [[0b101, 3], [symbol, 8]];  // simple, of one symbol, which has eight bits
  const body = packBits([[0x2f, 8], [size - 1, 14], [size - 1, 14], [0, 1 + 3], [0, 1 + 1 + 1],
    ...[green, red, blue, 255].flatMap(byteCode), [0b0001, 4]]);
  const padded = Buffer.concat([body, Buffer.alloc(body.length % 2)]);
  const head = Buffer.from('RIFF----WEBPVP8L----', 'latin1');
  head.writeUInt32LE(12 + padded.length, 4), head.writeUInt32LE(body.length, 16);
  return Buffer.concat([head, padded]);
}
