// Regions of interest: d = 0 inside, 1 outside (Alexa 2003, section 5.1).
import { add, at, diagonal, distance, dot, scale, subtract } from './vectors.mjs';

/** @return an object {name: d, one value a vertex} of all regions of a recipe */
export function measureRegions(recipe, mesh, sourceIndex, landmarks) {
  const fields = {};
  const measure = (name, path = []) => {
    if (path.includes(name)) throw new Error(`regions refer to each other: ${[...path, name].join(' -> ')}`);
    const region = recipe.regions?.[name];
    if (!region) throw new Error(`no region "${name}"`);
    if (!fields[name])
      fields[name] = region.ball
        ? measureBall(region.ball, recipe.units, mesh, sourceIndex(region.ball.on), landmarks)
        : measureRest([].concat(region.rest_of).map((other) => measure(other, [...path, name])));
    return fields[name];
  };
  for (const name of Object.keys(recipe.regions ?? {})) measure(name);
  return fields;
}

/** Inside the rest means outside of all the others. */
const measureRest = (others) =>
  others[0].map((_, i) => 1 - Math.min(...others.map((d) => d[i])));

function measureBall(ball, units, mesh, source, landmarks) {
  if (ball.distance !== 'edges') throw new Error('the reference measures "distance": "edges" only');
  const V = mesh.geometries[source];
  const unitLength = units === 'scene' ? 1 : diagonal(V);
  const centre = ball.at.position ?? landmarks[source][ball.at];
  if (!centre) throw new Error(`no landmark "${ball.at}"`);
  const [inner, outer] = [ball.inner * unitLength, ball.outer * unitLength];
  return edgeDistances(mesh, V, centre).map((r) => {
    if (r === Infinity) return 1;
    if (outer === inner) return r <= inner ? 0 : 1;
    return Math.min(1, Math.max(0, (r - inner) / (outer - inner)));
  });
}

/** Distances along edges from the surface point closest to `centre`. */
function edgeDistances(mesh, V, centre) {
  const { corners, point } = closestPoint(mesh, V, centre);
  const seeds = corners.map((i) => [distance(at(V, i), point), i]);
  return dijkstra(mesh.neighbours, V, seeds);
}

function closestPoint(mesh, V, centre) {
  let best = { distance: Infinity };
  for (let f = 0; f < mesh.corners.length; f += 3) {
    const corners = [0, 1, 2].map((k) => mesh.corners[f + k]);
    const point = closestInTriangle(centre, ...corners.map((i) => at(V, i)));
    const d = distance(point, centre);
    if (d < best.distance) best = { distance: d, corners, point };
  }
  return best;
}

/** The foot of the perpendicular if it falls inside, else the closest point of the three sides. */
function closestInTriangle(p, a, b, c) {
  const [u, v, w] = [subtract(b, a), subtract(c, a), subtract(p, a)];
  const [uu, uv, vv, wu, wv] = [dot(u, u), dot(u, v), dot(v, v), dot(w, u), dot(w, v)];
  const area = uu * vv - uv * uv;
  const beta = (vv * wu - uv * wv) / area;
  const gamma = (uu * wv - uv * wu) / area;
  if (area > 0 && beta >= 0 && gamma >= 0 && beta + gamma <= 1)
    return add(a, add(scale(u, beta), scale(v, gamma)));
  const feet = [[a, b], [b, c], [c, a]].map(([from, to]) => closestOnSegment(p, from, to));
  return feet.reduce((best, foot) => (distance(foot, p) < distance(best, p) ? foot : best));
}

function closestOnSegment(p, a, b) {
  const u = subtract(b, a);
  const s = dot(u, u) > 0 ? dot(subtract(p, a), u) / dot(u, u) : 0;
  return add(a, scale(u, Math.min(1, Math.max(0, s))));
}

function dijkstra(neighbours, V, seeds) {
  const r = new Float64Array(neighbours.length).fill(Infinity);
  const heap = [];
  const reach = (distanceTo, i) => {
    if (distanceTo < r[i]) r[i] = distanceTo, push(heap, [distanceTo, i]);
  };
  for (const [d, i] of seeds) reach(d, i);
  while (heap.length) {
    const [d, i] = pop(heap);
    if (d > r[i]) continue;
    for (const j of neighbours[i]) reach(d + distance(at(V, i), at(V, j)), j);
  }
  return r;
}

function push(heap, item) {
  heap.push(item);
  for (let i = heap.length - 1; i > 0; ) {
    const parent = (i - 1) >> 1;
    if (heap[parent][0] <= heap[i][0]) break;
    [heap[parent], heap[i]] = [heap[i], heap[parent]];
    i = parent;
  }
}

function pop(heap) {
  const top = heap[0];
  const last = heap.pop();
  if (!heap.length) return top;
  heap[0] = last;
  for (let i = 0; ; ) {
    let least = i;
    for (const child of [2 * i + 1, 2 * i + 2])
      if (child < heap.length && heap[child][0] < heap[least][0]) least = child;
    if (least === i) return top;
    [heap[least], heap[i]] = [heap[i], heap[least]];
    i = least;
  }
}
