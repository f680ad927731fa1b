// The sources of the test recipes: families of shapes with one connectivity.
// Usage: node make_shapes.mjs FOLDER    writes all of them
import { mkdirSync, writeFileSync } from 'node:fs';
import path from 'node:path';
import { pathToFileURL } from 'node:url';
import { localMatrix } from '../reference/glb.mjs';
import { add, cross, dot, scale, subtract, unit } from '../reference/vectors.mjs';
import { cylinderCap, cylinderSide, icosphere, join, torus } from './surfaces.mjs';
import { floats, indices, packGlb } from './write_glb.mjs';

const pebble = () => [icosphere(1)];
const orb = () => [icosphere(3)];
const boulder = () => [icosphere(4)];
const drum = () => [cylinderSide(24, 10), join(cylinderCap(24, 1), cylinderCap(24, -1))];
const duo = () => [torus(20, 12, 0.35), movedTo(icosphere(2), [0, 1.2, 0], 0.5)];

const movedTo = (part, centre, radius) => ({ ...part, points: part.points.map((p) => add(centre, scale(p, radius))) });
const bump = (p, centre, width) => Math.exp(-subtract(p, centre).reduce((sum, x) => sum + x * x, 0) / width ** 2);

const growNose = (p) =>
  add(scale(p, 1 + 0.7 * bump(p, [0, 0, 1], 0.35) + 0.3 * bump(p, [0, 0, -1], 0.5)), [0, 0, 0.2]);

function bend([x, y, z], turn) {
  const a = turn * (y + 1);
  return [x * Math.cos(a) - z * Math.sin(a) + 0.3 * y * y, y, x * Math.sin(a) + z * Math.cos(a)];
}

// "split" gives every corner a vertex of its own, without normals: exporters differ in where they split vertices.
const SHAPES = {
  'orb': { parts: orb, deform: (p) => p },
  'orb-long': { parts: orb, deform: ([x, y, z]) => [0.8 * x + 0.4, 1.6 * y + 0.25 * x * x, 0.9 * z] },
  'orb-moved': { parts: orb, deform: (p) => add(p, [0.5, -0.25, 2]) },
  'orb-nose': { parts: orb, split: true, deform: growNose },
  'pebble': { parts: pebble, deform: (p) => p },
  'pebble-nose': { parts: pebble, deform: growNose },
  'boulder': { parts: boulder, deform: (p) => p },
  'boulder-nose': { parts: boulder, deform: growNose },
  'drum': { parts: drum, deform: (p) => p, node: {
    translation: [0.5, 1, -2], rotation: [0.18257418583505536, 0.3651483716701107, 0.5477225575051661, 0.7302967433402214],
    scale: [0.5, 1.5, 1] } },
  'drum-bent': { parts: drum, deform: (p) => bend(p, 0.5) },
  'drum-squat': { parts: drum, deform: ([x, y, z]) => [x * (1.2 - 0.3 * y), 0.6 * y, z], node: { scale: [2, 2, 2] } },
  'duo': { parts: duo, deform: (p) => p, node: { scale: [-1, 1, 1], translation: [3, 0, 0] } },
  'duo-swollen': { parts: duo, node: { scale: [-1, 1, 1] }, deform: ([x, y, z]) =>
    [x * (1 + 0.4 * (x > 0 ? x * x : 0)), y, z + 0.2 * x] },
};
// Each lands in the middle of the face that looks most that way, so that no tie has to be broken.
const LANDMARKS = { nose: [0.11, 0.07, 1], tail: [-0.13, 0.09, -1], side: [1, 0.12, 0.21], top: [0.17, 1, 0.23] };

/** Writes the shape called `name` ("orb.glb") and its landmarks into `folder`. */
export function makeShape(name, folder) {
  const stem = path.basename(name, '.glb');
  const shape = SHAPES[stem];
  if (!shape) throw new Error(`no shape is called "${stem}"`);
  const parts = shape.parts().map((part) => deformPart(part, shape.deform));
  const file = path.join(folder, name);
  mkdirSync(path.dirname(file), { recursive: true });
  writeFileSync(file, writeShape(stem, parts, shape));
  const landmarks = Object.fromEntries(Object.entries(LANDMARKS).map(([landmark, direction]) =>
    [landmark, { position: placeLandmark(parts, direction, localMatrix(shape.node ?? {})) }]));
  writeFileSync(path.join(folder, `${stem}.landmarks.json`), JSON.stringify({ version: 1, landmarks }, null, 2));
}

function deformPart(part, deform) {
  const points = part.points.map(deform);
  const isDeformed = points.some((p, i) => p.some((x, k) => x !== part.points[i][k]));
  return { ...part, original: part.points, points, normals: isDeformed ? smoothNormals(points, part.triangles) : part.normals };
}

function faceNormal(points, [a, b, c]) {
  return cross(subtract(points[b], points[a]), subtract(points[c], points[a]));
}

function smoothNormals(points, triangles) {
  const sums = points.map(() => [0, 0, 0]);
  for (const triangle of triangles)
    for (const i of triangle) sums[i] = add(sums[i], faceNormal(points, triangle));
  return sums.map(unit);
}

function placeLandmark(parts, direction, matrix) {
  const middle = (points, triangle) => scale(triangle.reduce((sum, i) => add(sum, points[i]), [0, 0, 0]), 1 / 3);
  let best = { score: -Infinity };
  for (const part of parts)
    for (const triangle of part.triangles) {
      const score = dot(unit(middle(part.original, triangle)), unit(direction));
      if (score > best.score) best = { score, part, triangle };
    }
  const { part: { points }, triangle } = best;
  const p = add(middle(points, triangle), scale(unit(faceNormal(points, triangle)), 0.01));
  return [0, 1, 2].map((r) => matrix[r] * p[0] + matrix[4 + r] * p[1] + matrix[8 + r] * p[2] + matrix[12 + r]);
}

function writeShape(name, parts, { split = false, node = {} }) {
  const accessors = [];
  const primitives = parts.map((part, material) => ({ ...(split ? splitPrimitive : sharedPrimitive)(part, accessors), material }));
  return packGlb({
    scene: 0, scenes: [{ nodes: [0] }], nodes: [{ name, mesh: 0, ...node }],
    meshes: [{ name, primitives }],
    materials: parts.map((_, i) => ({ name: `paint-${i}`,
      pbrMetallicRoughness: { baseColorFactor: [0.9 - 0.4 * i, 0.5, 0.3 + 0.4 * i, 1], metallicFactor: 0 } })),
  }, accessors);
}

function sharedPrimitive({ points, normals, uvs, triangles }, accessors) {
  const put = (accessor) => accessors.push(accessor) - 1;
  const attributes = { POSITION: put(floats(points, 3)), NORMAL: put(floats(normals, 3)) };
  if (uvs) attributes.TEXCOORD_0 = put(floats(uvs, 2));
  return { attributes, indices: put(indices(triangles.flat())) };
}

function splitPrimitive({ points, triangles }, accessors) {
  const put = (accessor) => accessors.push(accessor) - 1;
  const corners = triangles.flat();
  return { attributes: { POSITION: put(floats(corners.map((i) => points[i]), 3)) },
    indices: put(indices(corners.map((_, corner) => corner))) };
}

if (import.meta.url === pathToFileURL(process.argv[1] ?? '').href)
  for (const name of Object.keys(SHAPES)) makeShape(`${name}.glb`, process.argv[2]);
