// Made meshes for the tests of this folder, and their files.
import { writeFileSync } from 'node:fs';
import { join } from 'node:path';

/** A sphere of `across` meridians and `along` parallels, each point changed by `change`. */
export function sphere(across, along, change = (p) => p) {
  const points = [[0, 0, 1]], faces = [];
  for (let i = 1; i < along; ++i) {
    for (let j = 0; j < across; ++j) {
      const t = (Math.PI * i) / along, u = (2 * Math.PI * j) / across;
      points.push([Math.sin(t) * Math.cos(u), Math.sin(t) * Math.sin(u), Math.cos(t)]);
    }
  }
  points.push([0, 0, -1]);
  const at = (i, j) => 1 + (i - 1) * across + (j % across);
  for (let j = 0; j < across; ++j) {
    faces.push([0, at(1, j), at(1, j + 1)], [points.length - 1, at(along - 1, j + 1), at(along - 1, j)]);
    for (let i = 1; i < along - 1; ++i) {
      faces.push([at(i, j), at(i + 1, j), at(i + 1, j + 1)], [at(i, j), at(i + 1, j + 1), at(i, j + 1)]);
    }
  }
  return { points: points.map(change), faces };
}

export function torus(n) {
  const points = [], faces = [];
  for (let i = 0; i < n; ++i) {
    for (let j = 0; j < n; ++j) {
      const u = (2 * Math.PI * i) / n, t = (2 * Math.PI * j) / n, r = 1 + 0.4 * Math.cos(t);
      points.push([r * Math.cos(u), r * Math.sin(u), 0.4 * Math.sin(t)]);
      const a = i * n + j, b = ((i + 1) % n) * n + j, c = ((i + 1) % n) * n + ((j + 1) % n), d = i * n + ((j + 1) % n);
      faces.push([a, b, c], [a, c, d]);
    }
  }
  return { points, faces };
}

/** Writes a mesh as NAME.gltf and NAME.bin. */
export function write_gltf(folder, name, { points, faces }) {
  const floats = Buffer.from(new Float32Array(points.flat()).buffer);
  const bytes = Buffer.concat([floats, Buffer.from(new Uint32Array(faces.flat()).buffer)]);
  const side = (pick) => [0, 1, 2].map((k) => points.reduce((best, p) => pick(best, Math.fround(p[k])), Math.fround(points[0][k])));
  writeFileSync(join(folder, `${name}.bin`), bytes);
  writeFileSync(join(folder, `${name}.gltf`), JSON.stringify({
    asset: { version: '2.0' }, scene: 0, scenes: [{ nodes: [0] }], nodes: [{ mesh: 0 }],
    meshes: [{ primitives: [{ attributes: { POSITION: 0 }, indices: 1 }] }],
    accessors: [
      { bufferView: 0, componentType: 5126, count: points.length, type: 'VEC3', min: side(Math.min), max: side(Math.max) },
      { bufferView: 1, componentType: 5125, count: 3 * faces.length, type: 'SCALAR' },
    ],
    bufferViews: [
      { buffer: 0, byteOffset: 0, byteLength: floats.length },
      { buffer: 0, byteOffset: floats.length, byteLength: bytes.length - floats.length },
    ],
    buffers: [{ byteLength: bytes.length, uri: `${name}.bin` }],
  }));
}
