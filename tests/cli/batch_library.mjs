// A small library of recipes for the tests of `batch`, and what they ask of its report.
import { createHash } from 'node:crypto';
import { mkdirSync, readdirSync, readFileSync, writeFileSync } from 'node:fs';
import path from 'node:path';
import { sphere, write_gltf } from './meshes.mjs';

/** A recipe that blends two spheres; `more` is put into it. */
export function recipe(more = {}) {
  return {
    version: 1, name: 'morph', sources: { ball: '../ball.gltf', egg: '../egg.gltf' },
    timeline: { tracks: [{ name: 'all', to: 'egg', begin: 0, end: 1 }] }, outputs: [{ file: 'morph.glb' }], ...more,
  };
}

/** Meshes of spheres in `folder`: ball, egg, and with `across` segments another that shares nothing. */
export function writeMeshes(folder, across = 12) {
  mkdirSync(folder, { recursive: true });
  write_gltf(folder, 'ball', sphere(across, across / 2));
  write_gltf(folder, 'egg', sphere(across, across / 2, ([x, y, z]) => [x, y, z * (z > 0 ? 1.8 : 1)]));
}

export function writeRecipe(file, more) {
  mkdirSync(path.dirname(file), { recursive: true });
  writeFileSync(file, JSON.stringify(recipe(more)));
}

export const linesOf = (file) => readFileSync(file, 'utf8').split('\n').filter(Boolean).map((line) => JSON.parse(line));

/** Hash by name of all files below a folder, but reports, which have times in them. */
export function bytesBelow(folder) {
  const hashes = {};
  for (const entry of readdirSync(folder, { recursive: true, withFileTypes: true })) {
    const file = path.join(entry.parentPath ?? entry.path, entry.name);
    if (entry.isDirectory() || /^(report|failures)\..*jsonl$/.test(entry.name) || entry.name === 'index.html') continue;
    hashes[path.relative(folder, file)] = createHash('sha256').update(readFileSync(file)).digest('hex');
  }
  return JSON.stringify(Object.entries(hashes).sort(), null, 1);
}

/** Processes that a process has started. */
export function childrenOf(pid) {
  try {
    return readFileSync(`/proc/${pid}/task/${pid}/children`, 'utf8').split(' ').filter(Boolean).map(Number);
  } catch {
    return [];
  }
}

export const sleep = (milliseconds) => new Promise((done) => setTimeout(done, milliseconds));

/** Waits until `holds`, at most a minute. */
export async function until(holds) {
  for (let i = 0; i < 6000 && !holds(); ++i) await sleep(10);
  return holds();
}
