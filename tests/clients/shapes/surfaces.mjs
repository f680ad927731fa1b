// Parts of shapes: {points, normals, uvs, triangles}, points before any deformation.
import { add, scale, unit } from '../reference/vectors.mjs';

/** A subdivided icosahedron of radius 1, smooth, no seam. */
export function icosphere(level) {
  const g = (1 + Math.sqrt(5)) / 2;
  let points = [[-1, g, 0], [1, g, 0], [-1, -g, 0], [1, -g, 0], [0, -1, g], [0, 1, g], [0, -1, -g], [0, 1, -g],
    [g, 0, -1], [g, 0, 1], [-g, 0, -1], [-g, 0, 1]].map(unit);
  let triangles = [[0, 11, 5], [0, 5, 1], [0, 1, 7], [0, 7, 10], [0, 10, 11], [1, 5, 9], [5, 11, 4], [11, 10, 2],
    [10, 7, 6], [7, 1, 8], [3, 9, 4], [3, 4, 2], [3, 2, 6], [3, 6, 8], [3, 8, 9], [4, 9, 5], [2, 4, 11],
    [6, 2, 10], [8, 6, 7], [9, 8, 1]];
  for (let i = 0; i < level; i++) ({ points, triangles } = subdivide(points, triangles));
  return { points, normals: points, triangles };
}

function subdivide(points, triangles) {
  const all = [...points];
  const middles = new Map();
  const middle = (a, b) => {
    const key = a < b ? `${a},${b}` : `${b},${a}`;
    if (!middles.has(key)) middles.set(key, all.push(unit(add(points[a], points[b]))) - 1);
    return middles.get(key);
  };
  const finer = triangles.flatMap(([a, b, c]) => {
    const [ab, bc, ca] = [middle(a, b), middle(b, c), middle(c, a)];
    return [[a, ab, ca], [b, bc, ab], [c, ca, bc], [ab, bc, ca]];
  });
  return { points: all, triangles: finer };
}

/**
 * A grid of (columns + 1) by (rows + 1) render vertices over [0, 1] x [0, 1].
 *
 * @param at      (u, v) -> [point, normal]; the last column repeats the first: a seam
 * @param closed  the last row repeats the first one too
 */
function grid(columns, rows, at, closed = false) {
  const part = { points: [], normals: [], uvs: [], triangles: [] };
  for (let row = 0; row <= rows; row++)
    for (let column = 0; column <= columns; column++) {
      // The same numbers on both sides of a seam, or it would not weld.
      const [point, normal] = at((column % columns) / columns, closed ? (row % rows) / rows : row / rows);
      part.points.push(point), part.normals.push(normal), part.uvs.push([column / columns, row / rows]);
    }
  for (let row = 0; row < rows; row++)
    for (let column = 0; column < columns; column++) {
      const a = row * (columns + 1) + column;
      const [b, c, d] = [a + 1, a + columns + 2, a + columns + 1];
      part.triangles.push([a, b, c], [a, c, d]);
    }
  return part;
}

/** The side of a cylinder of radius 1 and height 2 along y, with a seam. */
export const cylinderSide = (columns, rows) => grid(columns, rows, (u, v) => {
  const around = [Math.cos(2 * Math.PI * u), 0, -Math.sin(2 * Math.PI * u)];
  return [add(around, [0, 2 * v - 1, 0]), around];
});

/** Its cap at y = `side` (1 or -1): rings of triangles around a middle vertex; a hard edge at the rim. */
export function cylinderCap(columns, side) {
  const part = { points: [[0, side, 0]], normals: [[0, side, 0]], uvs: [[0.5, 0.5]], triangles: [] };
  const corner = (ring, column) => 1 + ring * columns + (column % columns);
  for (let ring = 0; ring < 2; ring++)
    for (let column = 0; column < columns; column++) {
      const [x, z] = [Math.cos(2 * Math.PI * column / columns), -Math.sin(2 * Math.PI * column / columns)];
      const r = (ring + 1) / 2;
      part.points.push([r * x, side, r * z]), part.normals.push([0, side, 0]), part.uvs.push([0.5 + r * x / 2, 0.5 + r * z / 2]);
      const next = column + 1;
      if (ring === 0) part.triangles.push([0, corner(0, column), corner(0, next)]);
      else part.triangles.push([corner(0, column), corner(1, column), corner(1, next)],
        [corner(0, column), corner(1, next), corner(0, next)]);
    }
  if (side < 0) part.triangles = part.triangles.map(([a, b, c]) => [a, c, b]);
  return part;
}

/** A torus around y: seams in both directions. */
export const torus = (columns, rows, thickness) => grid(columns, rows, (u, v) => {
  const around = [Math.cos(2 * Math.PI * u), 0, -Math.sin(2 * Math.PI * u)];
  const normal = add(scale(around, Math.cos(2 * Math.PI * v)), [0, Math.sin(2 * Math.PI * v), 0]);
  return [add(around, scale(normal, thickness)), normal];
}, true);

/** Several parts as one. */
export function join(...parts) {
  let offset = 0;
  const joined = { points: [], normals: [], uvs: [], triangles: [] };
  for (const part of parts) {
    joined.triangles.push(...part.triangles.map((triangle) => triangle.map((i) => i + offset)));
    for (const key of ['points', 'normals', 'uvs']) joined[key].push(...part[key]);
    offset += part.points.length;
  }
  return joined;
}
