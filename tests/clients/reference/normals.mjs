// Normals of a deformed frame: the source's own normals, carried along by the turning of the surface.
import { add, angle, at, cross, dot, scale, subtract, unit } from './vectors.mjs';

/** Corners that share a vertex and the NORMAL value in the first source; hard edges stay hard. */
export function groupCorners(mesh, source) {
  const groups = new Map();
  mesh.corners.forEach((vertex, c) => {
    if (Number.isNaN(source.normals[3 * c])) return;
    const key = `${vertex}:${source.normalKeys[c]}`;
    if (!groups.has(key)) groups.set(key, { corners: [], normal: at(source.normals, c) });
    groups.get(key).corners.push(c);
  });
  return [...groups.values()];
}

/** Angle-weighted sums of unit face normals, one unit vector a group. */
export function measureNormals(mesh, groups, positions, mirrored) {
  const weighted = weightedFaceNormals(mesh.corners, positions, mirrored ? -1 : 1);
  return groups.map(({ corners }) =>
    unit(corners.reduce((sum, c) => add(sum, weighted[c]), [0, 0, 0])));
}

function weightedFaceNormals(corners, positions, sign) {
  const weighted = [];
  for (let f = 0; f < corners.length; f += 3) {
    const p = [0, 1, 2].map((k) => at(positions, corners[f + k]));
    const normal = scale(unit(cross(subtract(p[1], p[0]), subtract(p[2], p[0]))), sign);
    for (let k = 0; k < 3; k++) {
      const [next, last] = [subtract(p[(k + 1) % 3], p[k]), subtract(p[(k + 2) % 3], p[k])];
      weighted.push(scale(normal, angle(next, last)));
    }
  }
  return weighted;
}

/**
 * Unit normals of the corners of one frame, NaN where the source has none.
 *
 * @param rest   measureNormals of the first source
 * @param moved  measureNormals of the frame
 */
export function carryNormals(mesh, groups, rest, moved) {
  const normals = new Float64Array(3 * mesh.corners.length).fill(NaN);
  groups.forEach((group, g) => {
    const normal = rotateSmallest(rest[g], moved[g], group.normal);
    for (const c of group.corners) normals.set(normal, 3 * c);
  });
  return normals;
}

/** The smallest rotation that takes unit `from` to unit `to`, applied to `v` (Rodrigues). */
export function rotateSmallest(from, to, v) {
  const axis = cross(from, to);
  const turned = add(v, cross(axis, v));
  return unit(add(turned, scale(cross(axis, cross(axis, v)), 1 / (1 + dot(from, to)))));
}
