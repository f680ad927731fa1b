// The two shapes that every form has: a bumpy ring with UV seams both ways, and the same one bent and stretched.
import { add, cross, subtract, unit } from '../reference/vectors.mjs';
import { torus } from '../shapes/surfaces.mjs';

export const COLUMNS = 17;
export const ROWS = 13;  // 18 by 14 vertices: as many as indices of one byte reach

const bump = ([x, y, z]) => 1 + 0.06 * Math.sin(3 * x + 1) * Math.cos(2 * z) + 0.04 * Math.sin(4 * y);
const bumpy = (p) => p.map((x) => x * bump(p));
const bent = ([x, y, z]) => [1.2 * x + 0.15 * y * y, 1.5 * y + 0.2 * x * x - 0.1 * z, 0.9 * z + 0.1 * Math.sin(2 * x)];

/** `p` deformed as in shape 'a' or 'b'. */
export const deform = (which, p) => (which === 'a' ? bumpy(p) : bent(bumpy(p)));

/** Shape 'a' or 'b': points, smooth normals, uvs, triangles. */
export const ring = (which) => reshape(torus(COLUMNS, ROWS, 0.35), which);

/** A disc of one vertex and `count` around it: what a fan can be. */
export function disc(which, count = 40) {
  const turn = (i) => 2 * Math.PI * i / count;
  const rim = Array.from({ length: count }, (_, i) => [Math.cos(turn(i)), 0.2 * Math.sin(2 * turn(i)), -Math.sin(turn(i))]);
  const flat = { points: [[0, 0.3, 0], ...rim], uvs: [[0.5, 0.5], ...rim.map(([x, , z]) => [0.5 + x / 2, 0.5 + z / 2])],
    triangles: rim.map((_, i) => [0, 1 + i, 1 + (i + 1) % count]) };
  return reshape(flat, which);
}

function reshape(part, which) {
  const points = part.points.map((p) => deform(which, p).map(Math.fround));
  return { ...part, points, normals: smoothNormals(points, part.triangles) };
}

/** Vertices of one place share a normal: a seam is not an edge. */
export function smoothNormals(points, triangles) {
  const sums = new Map();
  const key = (i) => points[i].join();
  for (const [a, b, c] of triangles) {
    const normal = cross(subtract(points[b], points[a]), subtract(points[c], points[a]));
    for (const i of [a, b, c]) sums.set(key(i), add(sums.get(key(i)) ?? [0, 0, 0], normal));
  }
  return points.map((_, i) => unit(sums.get(key(i))).map(Math.fround));
}

/** The ring's grid as one strip; rows are joined by triangles without area. */
export function ringStrip() {
  const strip = [];
  for (let row = 0; row < ROWS; row++) {
    const at = (column, side) => (row + side) * (COLUMNS + 1) + column;
    if (row > 0) strip.push(strip.at(-1), at(0, 1));
    for (let column = 0; column <= COLUMNS; column++) strip.push(at(column, 1), at(column, 0));
  }
  return strip;
}

/** Every corner a vertex of its own. */
export const unshared = (shape) => {
  const corners = shape.triangles.flat();
  const pick = (rows) => corners.map((i) => rows[i]);
  return { points: pick(shape.points), normals: pick(shape.normals), uvs: pick(shape.uvs) };
};

/** One of `parts` pieces of the shape's triangles, with its own vertices. */
export function pieceOf(shape, part, parts) {
  const from = Math.floor(part * shape.triangles.length / parts);
  const triangles = shape.triangles.slice(from, Math.floor((part + 1) * shape.triangles.length / parts));
  const used = [...new Set(triangles.flat())];
  const renamed = new Map(used.map((old, i) => [old, i]));
  const pick = (rows) => used.map((i) => rows[i]);
  return { points: pick(shape.points), normals: pick(shape.normals), uvs: pick(shape.uvs),
    triangles: triangles.map((triangle) => triangle.map((i) => renamed.get(i))) };
}
