// Ctrl-C and SIGTERM in the middle of a long triangulation and of a long resample: exit code 130 soon, nothing left.
//
//   node interrupt_remesh.mjs MORPHBAKE SCRATCH
import { spawn } from 'node:child_process';
import { existsSync, mkdirSync, readdirSync, rmSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { sphere, write_gltf } from './meshes.mjs';

const [program, scratch] = process.argv.slice(2);
const kPatience = 3;  // seconds; the program would give up by itself after 20
let failures = 0;
const wrong = (text) => { console.log(`WRONG: ${text}`); ++failures; };

rmSync(scratch, { recursive: true, force: true });
mkdirSync(scratch, { recursive: true });
write_gltf(scratch, 'a', sphere(24, 16));
write_gltf(scratch, 'b', sphere(24, 16, ([x, y, z]) => [x * (1 + 0.3 * z), 0.8 * y, 1.4 * z]));

/** Sources of a few hundred vertices that shall have a million: minutes of work in the stage that is asked for. */
function recipe(mode) {
  const file = join(scratch, `${mode}.json`);
  const landmarks = { top: { vertex: 0 }, bottom: { vertex: 361 }, front: { vertex: 169 }, left: { vertex: 175 } };
  writeFileSync(file, JSON.stringify({
    version: 1, name: 'x',
    sources: { a: { file: 'a.gltf', landmarks }, b: { file: 'b.gltf', landmarks } },
    connectivity: { mode, max_error: 0.00001, max_vertices: 1000000, target_edge_length: 0.0015 },
    timeline: { tracks: [{ name: 't', to: 'b', begin: 0, end: 1 }] },
  }));
  return file;
}

/** Sends the signal some seconds after the stage was announced. */
function interrupt(mode, stage, seconds, signal) {
  const out = join(scratch, `${mode}_out`);
  const run = spawn(program, ['remesh', recipe(mode), '-o', out]);
  let text = '', sent = 0;
  run.stderr.on('data', (data) => {
    text += data;
    if (sent || !text.includes(`${stage} ...`)) return;
    sent = Infinity;
    setTimeout(() => { sent = Date.now(); run.kill(signal); }, 1000 * seconds);
  });
  return new Promise((resolve) => run.on('close', (code) => {
    const took = (Date.now() - sent) / 1000;
    if (!(took < kPatience)) wrong(`${mode}: ended ${took} s after ${signal}`);
    if (code !== 130) wrong(`${mode}: exit code ${code} after ${signal}\n${text}`);
    if (!text.endsWith('interrupted; nothing was written\n')) wrong(`${mode}: says ${text}`);
    if (existsSync(out) && readdirSync(out).length) wrong(`${mode}: left ${readdirSync(out)}`);
    resolve();
  }));
}

await interrupt('remesh', 'triangulate', 2, 'SIGINT');
await interrupt('resample', 'resample', 0.5, 'SIGTERM');
await interrupt('resample', 'resample', 3, 'SIGINT');
if (!failures) console.log('all right');
process.exit(failures > 0 ? 1 : 0);
