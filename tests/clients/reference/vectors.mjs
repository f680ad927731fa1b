// Three numbers at a time, as plain arrays.

export const at = (values, i) => [values[3 * i], values[3 * i + 1], values[3 * i + 2]];
export const subtract = (a, b) => [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
export const add = (a, b) => [a[0] + b[0], a[1] + b[1], a[2] + b[2]];
export const scale = (a, s) => [a[0] * s, a[1] * s, a[2] * s];
export const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
export const cross = (a, b) => [
  a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
export const length = (a) => Math.hypot(a[0], a[1], a[2]);
export const distance = (a, b) => Math.hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);

/** `a` at length 1; the zero vector stays. */
export function unit(a) {
  const l = length(a);
  return l > 0 ? scale(a, 1 / l) : a;
}

/** Exact enough near 0 and 180 degrees, where the arc cosine loses half its digits. */
export const angle = (a, b) => Math.atan2(length(cross(a, b)), dot(a, b));

/** Diagonal of the bounding box of #V by 3 values. */
export function diagonal(values) {
  const low = [Infinity, Infinity, Infinity];
  const high = [-Infinity, -Infinity, -Infinity];
  values.forEach((value, i) => {
    low[i % 3] = Math.min(low[i % 3], value);
    high[i % 3] = Math.max(high[i % 3], value);
  });
  return distance(low, high);
}
