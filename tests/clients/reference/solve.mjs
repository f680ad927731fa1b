// What a bake solves (docs/method.md): K_L x = b with the `edge` right-hand side and a translation gauge, or, around
// held vertices, least squares in displacements from the start.

import { diagonal } from './vectors.mjs';

const TOLERANCE = 1e-12;

/**
 * What stands still. A component of which no edit ever touches 5 % of the area holds that part; the others keep the
 * centroid of what is untouched if it is 5 %, else of all of it.
 *
 * @param untouched  true a vertex
 * @param hold       the recipe's "hold": "auto", "none" or the names of regions
 * @param fields     d of every region, by name
 * @return           { held, reference }: booleans a vertex
 */
export function chooseConstraints(mesh, untouched, hold, fields) {
  const { component, areas } = mesh;
  const count = Math.max(...component) + 1;
  const [total, still] = [new Float64Array(count), new Float64Array(count)];
  component.forEach((c, i) => {
    total[c] += areas[i];
    if (untouched[i]) still[c] += areas[i];
  });
  const isLocal = (i) => still[component[i]] >= 0.05 * total[component[i]];
  const reference = untouched.map((stays, i) => stays || !isLocal(i));
  const isHeld = {
    auto: (i) => untouched[i] && isLocal(i),
    none: () => false,
  }[hold] ?? ((i) => hold.some((name) => fields[name][i] <= 1e-12));
  const held = untouched.map((_, i) => isHeld(i));
  const holds = new Array(count).fill(false);
  held.forEach((is, i) => { if (is) holds[component[i]] = true; });
  return { held, reference, inHolding: untouched.map((_, i) => holds[component[i]]) };
}

/**
 * Solves one frame.
 *
 * @param T      shares, one array a source
 * @param rest   the mix that edits start from: one share a source
 * @param start  #V by 3 values to start from, or null
 * @return       #V by 3, scene space
 */
export function solveFrame(mesh, constraints, T, rest, start) {
  const home = blendPositions(mesh, T.map((row, s) => row.map(() => rest[s])));
  const change = T.map((row, s) => row.map((share) => share - rest[s]));
  const blend = blendPositions(mesh, change);
  const b = edgeDifferences(mesh, change);
  const u = start ? start.map((value, k) => value - home[k]) : Float64Array.from(blend);
  for (let axis = 0; axis < 3; axis++) {
    const [goal, still] = [everyThird(b, axis), everyThird(blend, axis)];
    const solved = leastSquares(mesh, constraints, goal, still, conjugateGradient(mesh, constraints, goal, everyThird(u, axis)));
    solved.forEach((value, i) => { u[3 * i + axis] = value; });
  }
  const moved = translate(mesh, constraints, u, blend);
  return moved.map((value, k) => value + home[k]);
}

const everyThird = (values, axis) => Float64Array.from({ length: values.length / 3 }, (_, i) => values[3 * i + axis]);

/** sum_s T_s v_s. */
function blendPositions(mesh, T) {
  const blend = new Float64Array(3 * mesh.neighbours.length);
  mesh.geometries.forEach((V, s) => V.forEach((value, k) => { blend[k] += T[s][Math.floor(k / 3)] * value; }));
  return blend;
}

/** b_i = sum_j sum_s (T_s,i + T_s,j) / 2 (v_s,i - v_s,j). */
function edgeDifferences(mesh, T) {
  const b = new Float64Array(3 * mesh.neighbours.length);
  mesh.neighbours.forEach((ring, i) => {
    for (const j of ring)
      mesh.geometries.forEach((V, s) => {
        const share = (T[s][i] + T[s][j]) / 2;
        for (let k = 0; k < 3; k++) b[3 * i + k] += share * (V[3 * i + k] - V[3 * j + k]);
      });
  });
  return b;
}

function applyLaplacian({ neighbours }, x) {
  return x.map((value, i) => neighbours[i].reduce((sum, j) => sum - x[j], neighbours[i].length * value));
}

const dotProduct = (a, b) => a.reduce((sum, value, i) => sum + value * b[i], 0);

/** All components that hold nothing at once: the matrix is block-diagonal and b sums to 0 in each block. */
function conjugateGradient(mesh, { inHolding }, b, x) {
  b = b.map((value, i) => (inHolding[i] ? 0 : value));
  x = x.map((value, i) => (inHolding[i] ? 0 : value));
  const degrees = mesh.neighbours.map((ring) => ring.length || 1);
  // A morph that comes home leaves a b of rounding alone.
  const goal = TOLERANCE * Math.max(Math.sqrt(dotProduct(b, b)), 0.01 * diagonal(mesh.geometries[0]));
  let r = applyLaplacian(mesh, x).map((value, i) => b[i] - value);
  let z = r.map((value, i) => value / degrees[i]);
  let p = z;
  let rz = dotProduct(r, z);
  for (let iteration = 0; Math.sqrt(dotProduct(r, r)) > goal; iteration++) {
    if (iteration > 20 * b.length) throw new Error('the reference solver does not converge');
    const q = applyLaplacian(mesh, p);
    const step = rz / dotProduct(p, q);
    x = x.map((value, i) => value + step * p[i]);
    r = r.map((value, i) => value - step * q[i]);
    z = r.map((value, i) => value / degrees[i]);
    const before = rz;
    rz = dotProduct(r, z);
    p = p.map((value, i) => z[i] + (rz / before) * value);
  }
  return x;
}

/**
 * Minimises |L u - Deg^-1 b|^2 over the free vertices of components that hold some, with the others at `still`:
 * conjugate gradients on the least squares themselves (CGLS), the matrix scaled by nothing.
 */
function leastSquares(mesh, { held, inHolding }, b, still, x) {
  const { neighbours } = mesh;
  const isFree = held.map((is, i) => inHolding[i] && !is);
  if (!isFree.some(Boolean)) return x.map((value, i) => (held[i] ? still[i] : value));
  const L = (u) => u.map((value, i) => (inHolding[i] ? value - neighbours[i].reduce((sum, j) => sum + u[j], 0) / neighbours[i].length : 0));
  const transposed = (e) => e.map((value, i) =>
    (isFree[i] ? value - neighbours[i].reduce((sum, j) => sum + e[j] / neighbours[j].length, 0) : 0));
  let u = x.map((value, i) => (held[i] ? still[i] : inHolding[i] ? still[i] : 0));
  let e = L(u).map((value, i) => (inHolding[i] ? b[i] / neighbours[i].length - value : 0));
  let g = transposed(e);
  let p = g;
  let gg = dotProduct(g, g);
  const zero = L(u.map((value, i) => (held[i] ? value : 0))).map((value, i) => (inHolding[i] ? b[i] / neighbours[i].length - value : 0));
  const size = Math.sqrt(dotProduct(transposed(zero), transposed(zero)));
  const goal = (TOLERANCE * Math.max(size, 0.01 * diagonal(mesh.geometries[0]))) ** 2;
  for (let iteration = 0; gg > goal; iteration++) {
    if (iteration > 20 * b.length) throw new Error('the reference solver does not converge');
    const q = L(p);
    const step = gg / dotProduct(q, q);
    u = u.map((value, i) => value + step * p[i]);
    e = e.map((value, i) => value - step * q[i]);
    g = transposed(e);
    const before = gg;
    gg = dotProduct(g, g);
    p = p.map((value, i) => g[i] + (gg / before) * value);
  }
  return x.map((value, i) => (inHolding[i] ? u[i] : value));
}

/** Moves each component that holds nothing so that sum_R a_i u_i = sum_R a_i (sum_s dT_s,i v_s,i). */
function translate({ component, areas }, { reference, inHolding }, u, blend) {
  const count = Math.max(...component) + 1;
  const weight = new Float64Array(count);
  const offset = new Float64Array(3 * count);
  component.forEach((c, i) => {
    if (!reference[i]) return;
    weight[c] += areas[i];
    for (let k = 0; k < 3; k++) offset[3 * c + k] += areas[i] * (blend[3 * i + k] - u[3 * i + k]);
  });
  return u.map((value, k) => {
    const i = Math.floor(k / 3);
    return inHolding[i] ? value : value + offset[3 * component[i] + (k % 3)] / weight[component[i]];
  });
}
