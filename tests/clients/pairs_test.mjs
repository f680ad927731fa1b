// Real pairs on one connectivity: landmarks, distances and stretch from the files alone, the rest from the report.
// Usage: node pairs_test.mjs --morphbake PROGRAM --meshes FOLDER PAIR[=MEAN]...
import { spawnSync } from 'node:child_process';
import { existsSync, readFileSync, writeFileSync } from 'node:fs';
import path from 'node:path';
import { parseGlb, readAccessor, readTriangles } from './reference/glb.mjs';
import { readArguments, skip, startChecks, withFolder } from './support.mjs';

const { morphbake, meshes, files: pairs } = readArguments('morphbake', 'meshes');
if (!existsSync(meshes)) skip(`${meshes} is not there`);
const MAX_ERROR = 0.002;
const checks = startChecks();

const subtract = (a, b) => [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
const norm = (a) => Math.sqrt(dot(a, a));

/** Points and triangles of a file whose one mesh has no transform. */
function readMesh(file) {
  const glb = parseGlb(readFileSync(file));
  const [primitive] = glb.json.meshes[0].primitives;
  const flat = readAccessor(glb, primitive.attributes.POSITION);
  const points = Array.from({ length: flat.length / 3 }, (_, i) => Array.from(flat.subarray(3 * i, 3 * i + 3)));
  const corners = Array.from(readTriangles(glb, primitive));
  const triangles = Array.from({ length: corners.length / 3 }, (_, f) => corners.slice(3 * f, 3 * f + 3));
  return { points, triangles };
}

function diagonal({ points }) {
  const range = (c) => points.reduce(([low, high], p) => [Math.min(low, p[c]), Math.max(high, p[c])], [Infinity, -Infinity]);
  return norm([0, 1, 2].map((c) => { const [low, high] = range(c); return high - low; }));
}

/** Distance of a point from a triangle: over its plane if the foot is inside, else from its nearest edge. */
function triangleDistance(p, [a, b, c]) {
  const normal = cross(subtract(b, a), subtract(c, a));
  const isInside = [[a, b], [b, c], [c, a]].every(([u, v]) => dot(cross(subtract(v, u), subtract(p, u)), normal) >= 0);
  if (isInside && norm(normal) > 0) return Math.abs(dot(subtract(p, a), normal)) / norm(normal);
  return Math.min(...[[a, b], [b, c], [c, a]].map(([u, v]) => {
    const edge = subtract(v, u);
    const along = Math.min(1, Math.max(0, dot(subtract(p, u), edge) / (dot(edge, edge) || 1)));
    return norm(subtract(p, u.map((x, i) => x + along * edge[i])));
  }));
}

/** Largest distance of points from a mesh; triangles are found by the cells of a grid that they touch. */
function furthest(points, { points: corners, triangles }, limit) {
  const size = 4 * limit;
  const cell = (x) => Math.floor(x / size);
  const cells = new Map();
  triangles.forEach((triangle, f) => {
    const at = triangle.map((v) => corners[v]);
    const low = [0, 1, 2].map((c) => cell(Math.min(...at.map((p) => p[c])) - limit));
    const high = [0, 1, 2].map((c) => cell(Math.max(...at.map((p) => p[c])) + limit));
    for (let i = low[0]; i <= high[0]; i++)
      for (let j = low[1]; j <= high[1]; j++)
        for (let k = low[2]; k <= high[2]; k++) {
          const key = `${i},${j},${k}`;
          if (!cells.has(key)) cells.set(key, []);
          cells.get(key).push(f);
        }
  });
  // Whoever has no triangle within `limit` in his cell is too far away.
  return points.reduce((worst, p) => {
    const near = cells.get(p.map(cell).join()) ?? [];
    const distances = near.map((f) => triangleDistance(p, triangles[f].map((v) => corners[v])));
    return Math.max(worst, Math.min(Infinity, ...distances));
  }, 0);
}

const area = (mesh, triangle) => {
  const [a, b, c] = triangle.map((v) => mesh.points[v]);
  return norm(cross(subtract(b, a), subtract(c, a))) / 2;
};

/** Area-weighted mean of |J|^2 (1 + 1 / det J^2) / 4, both surfaces scaled to area 1. */
function meanDistortion(from, to) {
  const total = (mesh) => from.triangles.reduce((sum, triangle) => sum + area(mesh, triangle), 0);
  const [whole, other] = [total(from), total(to)];
  const squares = (mesh, scale, triangle) => {
    const [a, b, c] = triangle.map((v) => mesh.points[v].map((x) => x / Math.sqrt(scale)));
    const [u, v] = [subtract(b, a), subtract(c, a)];
    return [dot(u, u), dot(u, v), dot(v, v)];
  };
  return from.triangles.reduce((sum, triangle) => {
    const [e, f, g] = squares(from, whole, triangle);
    const [E, F, G] = squares(to, other, triangle);
    const determinant = e * g - f * f;
    const stretch = (E * g - 2 * F * f + G * e) / determinant;  // |J|^2: trace of the metric's quotient
    const areas = (E * G - F * F) / determinant;                // det J^2
    return sum + (area(from, triangle) / whole) * (stretch * (1 + 1 / areas)) / 4;
  }, 0);
}

await withFolder((folder) => {
  for (const each of pairs) {
    const [name, mostDistorted] = each.split('=');
    const pair = JSON.parse(readFileSync(path.join(meshes, `pair-${name}.json`), 'utf8'));
    const sources = Object.fromEntries(['a', 'b'].map((which) => [which, {
      file: path.join(meshes, pair[which]),
      landmarks: Object.fromEntries(pair.landmarks.map((mark) => [mark.name, { position: mark[which] }])),
    }]));
    const recipe = path.join(folder, `${name}.json`);
    const timeline = { tracks: [{ to: 'b', begin: 0, end: 1 }] };
    const connectivity = { mode: 'remesh', max_error: MAX_ERROR, max_vertices: 30000 };
    writeFileSync(recipe, JSON.stringify({ version: 1, name, sources, connectivity, timeline }));
    const report = path.join(folder, 'report.json');
    const words = ['remesh', recipe, '-o', folder, '--sheet', 'none', '--report', report];
    const run = spawnSync(morphbake, words, { encoding: 'utf8' });
    if (!checks.check(run.status === 0, `${name}: ${run.stderr}`)) continue;

    const made = { a: readMesh(path.join(folder, 'a.glb')), b: readMesh(path.join(folder, 'b.glb')) };
    checks.check(JSON.stringify(made.a.triangles) === JSON.stringify(made.b.triangles), `${name}: other triangles`);
    checks.check(made.a.points.length <= 30000, `${name}: ${made.a.points.length} vertices`);
    const vertexAt = (which, mark) => made[which].points.findIndex((p) => norm(subtract(p, mark)) < 1e-6 * diagonal(made[which]));
    for (const mark of pair.landmarks) {
      const vertex = vertexAt('a', mark.a);
      checks.check(vertex >= 0 && vertex === vertexAt('b', mark.b), `${name}: "${mark.name}" is not one vertex of both`);
    }
    for (const which of ['a', 'b']) {
      const source = readMesh(path.join(meshes, pair[which]));
      const limit = MAX_ERROR * diagonal(source);
      const middles = (mesh) => mesh.triangles.map((t) => [0, 1, 2].map((c) => t.reduce((sum, v) => sum + mesh.points[v][c] / 3, 0)));
      const there = furthest([...source.points, ...middles(source)], made[which], limit);
      const back = furthest([...made[which].points, ...middles(made[which])], source, limit);
      console.log(`${name} ${pair[which]}: ${(there / limit).toFixed(2)} and ${(back / limit).toFixed(2)} of max_error`);
      checks.check(there <= limit && back <= limit, `${name}: ${pair[which]} is further than max_error`);
    }
    const mean = meanDistortion(made.a, made.b);
    console.log(`${name}: ${made.a.points.length} vertices, mean distortion ${mean.toFixed(3)}`);
    if (mostDistorted) checks.check(mean < Number(mostDistorted), `${name}: mean distortion ${mean}`);
    const { connectivity: measured } = JSON.parse(readFileSync(report, 'utf8'));
    checks.check(Math.abs(measured.distortion[0].mean - mean) < 1e-3 * mean, `${name}: the report says ${measured.distortion[0].mean}`);
    for (const source of measured.sources) {
      checks.check(source.sphere.flipped_triangles === 0, `${name}: flips on ${source.source}`);
      checks.check(source.folds === 0, `${name}: ${source.folds} folds on ${source.source}`);
      checks.check(source.new_self_intersections === 0, `${name}: new self-intersections on ${source.source}`);
      checks.check(source.landmark_error === 0, `${name}: landmark error on ${source.source}`);
    }
  }
});
checks.finish('real pairs');
