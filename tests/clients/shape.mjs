// Shapes of evaluated scenes (reference/scene.mjs), to compare them.
import { at, distance } from './reference/vectors.mjs';

/** Corner by corner, primitive after primitive, #C by 3. */
export function shapeOf(scene, node) {
  const { primitives } = scene.find((each) => each.node === node);
  return primitives.flatMap(({ positions, corners }) => corners.flatMap((i) => at(positions, i)));
}

/** The largest distance of corners. */
export function farthest(found, expected) {
  if (found.length !== expected.length) return Infinity;
  let far = 0;
  for (let i = 0; 3 * i < found.length; i++) far = Math.max(far, distance(at(found, i), at(expected, i)));
  return far;
}
