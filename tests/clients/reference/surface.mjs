// Sources with one connectivity: welded vertices, their graph, areas and components.
import { readFileSync } from 'node:fs';
import { findMeshNode, parseGlb, readAccessor, readTriangles } from './glb.mjs';
import { at, cross, length, subtract, unit } from './vectors.mjs';

/**
 * The corners of a source file's triangles, all primitives one after the other.
 *
 * @return positions  #corners by 3, scene space; normals: unit, scene space, NaN where the file has none;
 *                    normalKeys: a string a corner, equal iff the NORMAL values are;
 *                    primitiveCorners: number of corners of each primitive; mirrored: the node flips the winding
 */
export function readCorners(file) {
  const glb = parseGlb(readFileSync(file));
  const { node, matrix } = findMeshNode(glb);
  const corners = { positions: [], normals: [], normalKeys: [], primitiveCorners: [] };
  const toNormal = cofactors(matrix);
  corners.mirrored = determinant(matrix) < 0;
  for (const primitive of glb.json.meshes[node.mesh].primitives)
    appendPrimitive(corners, glb, primitive, matrix, toNormal);
  return corners;
}

function appendPrimitive(corners, glb, primitive, matrix, toNormal) {
  const positions = readAccessor(glb, primitive.attributes.POSITION);
  const hasNormals = primitive.attributes.NORMAL !== undefined;
  const normals = hasNormals ? readAccessor(glb, primitive.attributes.NORMAL) : null;
  const triangles = readTriangles(glb, primitive);
  for (const vertex of triangles) {
    corners.positions.push(...transformPoint(matrix, at(positions, vertex)));
    const normal = hasNormals ? at(normals, vertex) : [NaN, NaN, NaN];
    corners.normalKeys.push(normal.map((x) => x + 0).join());
    const carried = unit(transformDirection(toNormal, normal));
    corners.normals.push(...(corners.mirrored ? carried.map((x) => -x) : carried));
  }
  corners.primitiveCorners.push(triangles.length);
}

const transformPoint = (m, p) =>
  [0, 1, 2].map((r) => m[r] * p[0] + m[4 + r] * p[1] + m[8 + r] * p[2] + m[12 + r]);
const transformDirection = (columns, p) =>
  [0, 1, 2].map((r) => columns[0][r] * p[0] + columns[1][r] * p[1] + columns[2][r] * p[2]);
const columnsOf = (m) => [0, 4, 8].map((c) => [m[c], m[c + 1], m[c + 2]]);

function determinant(matrix) {
  const [x, y, z] = columnsOf(matrix);
  return x[0] * (y[1] * z[2] - y[2] * z[1]) + x[1] * (y[2] * z[0] - y[0] * z[2]) + x[2] * (y[0] * z[1] - y[1] * z[0]);
}

/** Columns of det(M) M^-T, which carries normals up to length (and sign, for a mirrored node). */
function cofactors(matrix) {
  const [x, y, z] = columnsOf(matrix);
  return [cross(y, z), cross(z, x), cross(x, y)];
}

/**
 * Welds sources of the same face order.
 *
 * @param sources  from readCorners
 * @return corners: vertex of each corner; geometries: #V by 3 a source; neighbours: a list a vertex;
 *         component: of each vertex; areas: of each vertex, summed over the sources
 */
export function weld(sources) {
  const cornerCount = sources[0].positions.length / 3;
  for (const source of sources)
    if (source.positions.length !== 3 * cornerCount) throw new Error('sources differ in their number of faces');
  const vertexOf = new Map();
  const corners = new Int32Array(cornerCount);
  const firstCorner = [];
  for (let c = 0; c < cornerCount; c++) {
    // + 0 makes -0 the same position as 0.
    const key = sources.map((source) => at(source.positions, c).map((x) => x + 0).join()).join('|');
    if (!vertexOf.has(key)) firstCorner[vertexOf.size] = c, vertexOf.set(key, vertexOf.size);
    corners[c] = vertexOf.get(key);
  }
  const geometries = sources.map((source) =>
    Float64Array.from(firstCorner.flatMap((c) => at(source.positions, c))));
  const neighbours = findNeighbours(corners, firstCorner.length);
  return { corners, geometries, neighbours, component: findComponents(neighbours),
    areas: vertexAreas(corners, geometries) };
}

function findNeighbours(corners, vertexCount) {
  const sets = Array.from({ length: vertexCount }, () => new Set());
  for (let f = 0; f < corners.length; f += 3)
    for (let k = 0; k < 3; k++) {
      const [i, j] = [corners[f + k], corners[f + ((k + 1) % 3)]];
      if (i !== j) sets[i].add(j), sets[j].add(i);
    }
  return sets.map((set) => [...set]);
}

function findComponents(neighbours) {
  const component = new Int32Array(neighbours.length).fill(-1);
  let count = 0;
  for (let seed = 0; seed < neighbours.length; seed++) {
    if (component[seed] >= 0) continue;
    const queue = [seed];
    component[seed] = count;
    while (queue.length)
      for (const j of neighbours[queue.pop()]) if (component[j] < 0) component[j] = count, queue.push(j);
    count++;
  }
  return component;
}

function vertexAreas(corners, geometries) {
  const areas = new Float64Array(geometries[0].length / 3);
  for (const V of geometries)
    for (let f = 0; f < corners.length; f += 3) {
      const [a, b, c] = [0, 1, 2].map((k) => at(V, corners[f + k]));
      const third = length(cross(subtract(b, a), subtract(c, a))) / 6;
      for (let k = 0; k < 3; k++) areas[corners[f + k]] += third;
    }
  return areas;
}
