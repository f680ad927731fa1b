// Figure 1 of the paper in numbers: the nose of one face on another, by morphbake and by interpolating
// absolute positions over the same region. Shares no code with the library: the tests' own reader,
// welding and region are used.
//
//   morphbake bake docs/faces/recipe.json
//   node docs/faces/measure.mjs docs/faces/recipe.json docs/faces/out/nose-still.glb docs/faces/out/absolute.glb
//
// Writes the absolute interpolation as the third file, to be looked at beside the second.
import { readFileSync, writeFileSync } from 'node:fs';
import path from 'node:path';
import { openRecipe } from '../../tests/clients/reference_frames.mjs';
import { findMeshNode, parseGlb, readTriangles } from '../../tests/clients/reference/glb.mjs';
import { readCorners } from '../../tests/clients/reference/surface.mjs';
import { add, at, cross, diagonal, distance, dot, scale, subtract, unit } from '../../tests/clients/reference/vectors.mjs';

const [recipeFile, bakedFile, absoluteFile] = process.argv.slice(2);
const { recipe, mesh, fields } = openRecipe(recipeFile);
const [A, B] = mesh.geometries;
const d = fields.nose;
const count = A.length / 3;
const vertices = [...Array(count).keys()];

const mean = (geometry, chosen) =>
  scale(chosen.reduce((sum, v) => add(sum, at(geometry, v)), [0, 0, 0]), 1 / chosen.length);

/** `geometry` moved so that the mean of `chosen` is where it is in A. */
function aligned(geometry, chosen) {
  const offset = subtract(mean(A, chosen), mean(geometry, chosen));
  return Float64Array.from(geometry, (value, i) => value + offset[i % 3]);
}

/** Positions of the welded vertices in a baked file with the corners of the first source. */
function weldedPositions(file) {
  const corners = readCorners(file).positions;
  const positions = new Float64Array(A.length);
  mesh.corners.forEach((vertex, corner) => {
    for (let k = 0; k < 3; k += 1) positions[3 * vertex + k] = corners[3 * corner + k];
  });
  return positions;
}

/** The paper's figure 1, middle right: (1 - T) V(0) + T V(1). */
function absoluteInterpolation(target) {
  return Float64Array.from(A, (value, i) => {
    const share = 1 - d[Math.floor(i / 3)];
    return (1 - share) * value + share * target[i];
  });
}

/** Edges with both triangles beside them: [a, b, opposite, opposite]. */
function innerEdges() {
  const beside = new Map();
  for (let c = 0; c < mesh.corners.length; c += 3) {
    for (let k = 0; k < 3; k += 1) {
      const [a, b, o] = [0, 1, 2].map((n) => mesh.corners[c + ((k + n) % 3)]);
      const key = a < b ? `${a} ${b}` : `${b} ${a}`;
      beside.set(key, [...(beside.get(key) ?? []), o]);
    }
  }
  return [...beside].filter(([, o]) => o.length === 2).map(([key, o]) => [...key.split(' ').map(Number), ...o]);
}

function dihedral(geometry, [a, b, left, right]) {
  const edge = subtract(at(geometry, b), at(geometry, a));
  const normal = (o) => unit(cross(edge, subtract(at(geometry, o), at(geometry, a))));
  const cosine = -dot(normal(left), normal(right));
  return (Math.acos(Math.max(-1, Math.min(1, cosine))) * 180) / Math.PI;
}

const quantile = (values, q) => [...values].sort((x, y) => x - y)[Math.floor(q * (values.length - 1))];

function measure(geometry) {
  const ring = vertices.filter((v) => d[v] > 0 && d[v] < 1);
  const tip = vertices.reduce((best, v) => (distance(at(A, v), landmark) < distance(at(A, best), landmark) ? v : best));
  const edges = innerEdges();
  const inRing = edges.filter(([a, b]) => d[a] > 0 && d[a] < 1 && d[b] > 0 && d[b] < 1);
  // What the surface bends by where the shares change, against the same mix of both faces' own bending.
  const bends = inRing.map((edge) => {
    const share = 1 - (d[edge[0]] + d[edge[1]]) / 2;
    const expected = (1 - share) * dihedral(A, edge) + share * dihedral(B, edge);
    return Math.abs(dihedral(geometry, edge) - expected);
  });
  const inNose = edges.filter(([a, b]) => d[a] === 0 && d[b] === 0);
  const stretches = inNose.map(([a, b]) => distance(at(geometry, a), at(geometry, b)) / distance(at(B, a), at(B, b)) - 1);
  const root = Math.sqrt(stretches.reduce((sum, s) => sum + s * s, 0) / stretches.length);
  const wanted = at(aligned(B, ring), tip);
  return {
    'tip misplaced, % of the diagonal': (100 * distance(at(geometry, tip), wanted)) / diagonal(A),
    'dihedral change in the ring, median, degrees': quantile(bends, 0.5),
    'dihedral change in the ring, 95th percentile': quantile(bends, 0.95),
    'dihedral change in the ring, largest': Math.max(...bends),
    'edge lengths of the nose against the boy\'s, rms %': 100 * root,
  };
}

/** The first source's file with other positions; without normals, which readers then make flat. */
function writeWithPositions(file, geometry) {
  const source = recipe.sources[Object.keys(recipe.sources)[0]].file;
  const bytes = readFileSync(path.resolve(path.dirname(recipeFile), source));
  const glb = parseGlb(bytes);
  const primitive = glb.json.meshes[findMeshNode(glb).node.mesh].primitives[0];
  const accessor = glb.json.accessors[primitive.attributes.POSITION];
  const view = glb.json.bufferViews[accessor.bufferView];
  const start = 28 + bytes.readUInt32LE(12) + (view.byteOffset ?? 0) + (accessor.byteOffset ?? 0);
  const indices = readTriangles(glb, primitive);
  mesh.corners.forEach((vertex, corner) => {
    for (let k = 0; k < 3; k += 1) bytes.writeFloatLE(geometry[3 * vertex + k], start + 12 * indices[corner] + 4 * k);
  });
  writeFileSync(file, bytes);
}

const landmark = recipe.sources.baby.landmarks.nose.position;
const columns = {
  morphbake: weldedPositions(bakedFile),
  'absolute, faces aligned': absoluteInterpolation(aligned(B, vertices)),
  'absolute, as the files stand': absoluteInterpolation(B),
};
const measured = Object.values(columns).map(measure);
console.log(`| measure | ${Object.keys(columns).join(' | ')} |`);
console.log(`|---|${'---|'.repeat(measured.length)}`);
for (const name of Object.keys(measured[0])) {
  console.log(`| ${name} | ${measured.map((column) => column[name].toFixed(2)).join(' | ')} |`);
}
if (absoluteFile) writeWithPositions(absoluteFile, columns['absolute, faces aligned']);
