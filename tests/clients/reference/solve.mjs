// K_L x = b with the `edge` right-hand side and the translation gauge (design.md, section 5).

const TOLERANCE = 1e-12;

/**
 * The vertices that fix the translation of each component: what never changes if that is 5 % of
 * the component's area, else all of it.
 *
 * @return true a vertex that belongs to its component's reference set
 */
export function chooseReference(mesh, unchanging) {
  const { component, areas } = mesh;
  const count = Math.max(...component) + 1;
  const [total, still] = [new Float64Array(count), new Float64Array(count)];
  component.forEach((c, i) => {
    total[c] += areas[i];
    if (unchanging[i]) still[c] += areas[i];
  });
  return unchanging.map((stays, i) => stays || still[component[i]] < 0.05 * total[component[i]]);
}

/**
 * Solves one frame.
 *
 * @param T      shares, one array a source
 * @param start  #V by 3 values to start from, or null
 * @return       #V by 3, scene space
 */
export function solveFrame(mesh, reference, T, start) {
  const blend = blendPositions(mesh, T);
  const x = Float64Array.from(start ?? blend);
  const b = edgeDifferences(mesh, T);
  for (let axis = 0; axis < 3; axis++) {
    const solved = conjugateGradient(mesh, everyThird(b, axis), everyThird(x, axis));
    solved.forEach((value, i) => { x[3 * i + axis] = value; });
  }
  return translate(mesh, reference, x, blend);
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

/** All components at once: the matrix is block-diagonal and b sums to 0 in each block. */
function conjugateGradient(mesh, b, x) {
  const degrees = mesh.neighbours.map((ring) => ring.length || 1);
  const goal = TOLERANCE * Math.sqrt(dotProduct(b, b));
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

/** Moves each component so that sum_R a_i x_i = sum_R a_i (sum_s T_s,i v_s,i). */
function translate({ component, areas }, reference, x, blend) {
  const count = Math.max(...component) + 1;
  const weight = new Float64Array(count);
  const offset = new Float64Array(3 * count);
  component.forEach((c, i) => {
    if (!reference[i]) return;
    weight[c] += areas[i];
    for (let k = 0; k < 3; k++) offset[3 * c + k] += areas[i] * (blend[3 * i + k] - x[3 * i + k]);
  });
  return x.map((value, k) => {
    const c = component[Math.floor(k / 3)];
    return value + offset[3 * c + (k % 3)] / weight[c];
  });
}
