// An independent implementation of a bake: a recipe's frames in float64, one solve a frame.
// Shares no code and no shortcut (separability, factorisation) with the library.
// Usage: node reference_frames.mjs RECIPE    prints what it found
import { existsSync, readFileSync } from 'node:fs';
import path from 'node:path';
import { pathToFileURL } from 'node:url';
import { carryNormals, groupCorners, measureNormals } from './reference/normals.mjs';
import { measureRegions } from './reference/regions.mjs';
import { chooseConstraints, solveFrame } from './reference/solve.mjs';
import { readCorners, weld } from './reference/surface.mjs';
import { findUntouched, readTimeline, transitionAt, untouchedIn } from './reference/timeline.mjs';
import { diagonal } from './reference/vectors.mjs';

/** Reads a recipe and its sources; nothing is solved yet. */
export function openRecipe(file) {
  const recipe = JSON.parse(readFileSync(file, 'utf8'));
  const folder = path.dirname(file);
  const names = Object.keys(recipe.sources);
  const files = names.map((name) => path.resolve(folder, recipe.sources[name].file ?? recipe.sources[name]));
  const sources = files.map(readCorners);
  const mesh = weld(sources);
  const landmarks = names.map((name, s) => readLandmarks(recipe.sources[name].landmarks, folder, files[s]));
  const fields = measureRegions(recipe, mesh, (name) => names.indexOf(name), landmarks);
  const timeline = readTimeline(recipe, names, fields, mesh.neighbours.length);
  const constraints = chooseConstraints(mesh, findUntouched(timeline), recipe.hold ?? 'auto', fields);
  const groups = groupCorners(mesh, sources[0]);
  const restNormals = measureNormals(mesh, groups, mesh.geometries[0], sources[0].mirrored);
  return { recipe, sources, mesh, fields, timeline, constraints, groups, restNormals, latest: null };
}

/** A file's name, the landmarks themselves, or nothing: then the file beside the source. */
function readLandmarks(written, folder, sourceFile) {
  if (typeof written === 'object') return positionsOf(written);
  const beside = sourceFile.replace(/\.[^.]*$/, '.landmarks.json');
  const file = written ? path.resolve(folder, written) : beside;
  if (!existsSync(file)) return {};
  return positionsOf(JSON.parse(readFileSync(file, 'utf8')).landmarks);
}

const positionsOf = (landmarks) =>
  Object.fromEntries(Object.entries(landmarks).map(([name, { position }]) => [name, position]));

/** Times of all frames in seconds. */
export function frameTimes({ timeline: { fps, duration } }) {
  return Array.from({ length: Math.round(duration * fps) + 1 }, (_, f) => f / fps);
}

/** The shape at a time in seconds, or of a state by name: #V by 3 positions of the welded vertices. */
export function solveShape(opened, at) {
  const { mesh, timeline, constraints, recipe, fields } = opened;
  if (typeof at === 'string') {
    const { T, rest } = timeline.stateNamed(at);  // a still holds and stands by itself
    const own = chooseConstraints(mesh, untouchedIn(timeline, rest, [T]), recipe.hold ?? 'auto', fields);
    return solveFrame(mesh, own, T, rest, null);
  }
  opened.latest = solveFrame(mesh, constraints, transitionAt(timeline, at), timeline.rest, opened.latest);
  return opened.latest;
}

/** Positions and unit normals of the source's triangle corners, in scene space. */
export function cornersOf(opened, positions) {
  const { mesh, groups, restNormals, sources } = opened;
  const corners = new Float64Array(3 * mesh.corners.length);
  mesh.corners.forEach((i, c) => corners.set(positions.subarray(3 * i, 3 * i + 3), 3 * c));
  const moved = measureNormals(mesh, groups, positions, sources[0].mirrored);
  return { positions: corners, normals: carryNormals(mesh, groups, restNormals, moved) };
}

/**
 * What a viewer should show of one output.
 *
 * @return times in seconds (frames and the middles between them) and a shape a time; a still has one
 *         time. Between frames a "tracks" output follows the timeline, a "frames" output goes straight.
 */
export function expectOutput(opened, output) {
  if (output.still) return { times: [0], shapes: [solveShape(opened, output.still.at)] };
  const frames = frameTimes(opened);
  const shapes = frames.map((t) => solveShape(opened, t));
  const middles = frames.slice(1).map((t, f) => (t + frames[f]) / 2);
  const between = middles.map((t, f) =>
    output.targets === 'frames'
      ? shapes[f].map((value, k) => (value + shapes[f + 1][k]) / 2)
      : solveShape(opened, t));
  return { times: [...frames, ...middles], shapes: [...shapes, ...between] };
}

function describe(file) {
  const opened = openRecipe(file);
  const { mesh, timeline, constraints, fields } = opened;
  console.log(`${mesh.neighbours.length} vertices, ${mesh.corners.length / 3} triangles, ` +
    `${Math.max(...mesh.component) + 1} components, ${timeline.duration} s, ${frameTimes(opened).length} frames`);
  for (const [name, d] of Object.entries(fields))
    console.log(`region ${name}: ${d.filter((x) => x === 0).length} inside, ${d.filter((x) => x === 1).length} outside`);
  console.log(`${constraints.held.filter(Boolean).length} vertices are held`);
  const end = solveShape(opened, timeline.duration);
  console.log(`diagonal at the end: ${diagonal(end)}`);
}

if (import.meta.url === pathToFileURL(process.argv[1] ?? '').href) describe(process.argv[2]);
