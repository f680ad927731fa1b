// The maps lead from the source files to the remeshed ones: docs/maps.md, read without the writer's code.
// Usage: node maps_test.mjs --morphbake PROGRAM RECIPE
import { spawnSync } from 'node:child_process';
import { readFileSync } from 'node:fs';
import path from 'node:path';
import { readArguments, startChecks, withFolder } from './support.mjs';

const { morphbake, files: [recipeFile] } = readArguments('morphbake');
const checks = startChecks();

/** The accessor's numbers, element by element. */
function readAccessor({ json, binary }, index) {
  const accessor = json.accessors[index];
  const view = json.bufferViews[accessor.bufferView];
  const columns = { SCALAR: 1, VEC3: 3 }[accessor.type];
  const [size, read] = { 5126: [4, 'readFloatLE'], 5123: [2, 'readUInt16LE'], 5125: [4, 'readUInt32LE'] }[accessor.componentType];
  const begin = (view.byteOffset ?? 0) + (accessor.byteOffset ?? 0);
  const stride = view.byteStride ?? size * columns;
  return Array.from({ length: accessor.count }, (_, i) =>
    Array.from({ length: columns }, (_, c) => binary[read](begin + i * stride + c * size)));
}

function openGlb(file) {
  const bytes = readFileSync(file);
  const length = bytes.readUInt32LE(12);
  return { json: JSON.parse(bytes.toString('utf8', 20, 20 + length)), binary: bytes.subarray(20 + length + 8) };
}

/** Corner positions of all triangles, over primitives. */
function triangles(file) {
  const glb = openGlb(file);
  return glb.json.meshes[0].primitives.flatMap(({ attributes, indices }) => {
    const positions = readAccessor(glb, attributes.POSITION);
    const corners = readAccessor(glb, indices).map(([i]) => positions[i]);
    return Array.from({ length: corners.length / 3 }, (_, f) => corners.slice(3 * f, 3 * f + 3));
  });
}

function readMaps(file) {
  const bytes = readFileSync(file);
  checks.check(bytes.toString('latin1', 0, 8) === 'MORPHMAP' && bytes.readUInt32LE(8) === 1, 'wrong magic or version');
  const vertices = bytes.readUInt32LE(12);
  const maps = [];
  let at = 24;
  const padded = (n) => (n + 7) & ~7;
  for (let s = 0; s < bytes.readUInt32LE(16); ++s) {
    const length = bytes.readUInt32LE(at);
    const triangleCount = bytes.readUInt32LE(at + 4);
    const name = bytes.toString('utf8', at + 8, at + 8 + length);
    at += padded(8 + length);
    const faces = Array.from({ length: vertices }, (_, v) => bytes.readUInt32LE(at + 4 * v));
    at += padded(4 * vertices);
    const shares = Array.from({ length: vertices }, (_, v) => [0, 1, 2].map((k) => bytes.readDoubleLE(at + 24 * v + 8 * k)));
    at += 24 * vertices;
    maps.push({ name, triangleCount, faces, shares });
  }
  checks.check(at === bytes.length, `${bytes.length - at} bytes are left over`);
  return maps;
}

await withFolder((folder) => {
  const run = spawnSync(morphbake, ['remesh', recipeFile, '-o', folder, '--sheet', 'none'], { encoding: 'utf8' });
  if (!checks.check(run.status === 0, run.stderr)) return;
  const recipe = JSON.parse(readFileSync(recipeFile, 'utf8'));
  const maps = readMaps(path.join(folder, `${recipe.name}.maps.bin`));
  checks.check(maps.map(({ name }) => name).join() === Object.keys(recipe.sources).join(), 'other sources');
  for (const { name, triangleCount, faces, shares } of maps) {
    const source = recipe.sources[name];
    const of = triangles(path.resolve(path.dirname(recipeFile), source.file ?? source));
    const glb = openGlb(path.join(folder, `${name}.glb`));
    const positions = readAccessor(glb, glb.json.meshes[0].primitives[0].attributes.POSITION);
    checks.check(of.length === triangleCount && positions.length === faces.length, `${name}: other counts`);
    let worst = 0;
    positions.forEach((position, v) => position.forEach((coordinate, c) => {
      const expected = [0, 1, 2].reduce((sum, k) => sum + shares[v][k] * of[faces[v]][k][c], 0);
      worst = Math.max(worst, Math.abs(coordinate - expected));
    }));
    console.log(`${name}: ${positions.length} vertices, worst ${worst}`);
    checks.check(worst < 1e-6, `${name}: off by ${worst}`);
  }
});
checks.finish('the maps give the positions');
