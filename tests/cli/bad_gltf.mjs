// Hostile glTF sources, each made here by one change to a good file, and what must be told of them.
//
//   node bad_gltf.mjs MORPHBAKE SCRATCH [PART OF A NAME]
//
// Every case must end with exit code 4 within 10 s and 1 GiB, name the file, the place and the code, and leave no output
// behind. Legal files that are huge may also be read.
import { execFileSync, spawnSync } from 'node:child_process';
import { mkdirSync, readFileSync, readdirSync, rmSync, symlinkSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import * as accessors from './bad_gltf/accessors.mjs';
import * as container from './bad_gltf/container.mjs';
import { octahedron } from './bad_gltf/good.mjs';
import * as huge from './bad_gltf/huge.mjs';
import * as packed from './bad_gltf/packed.mjs';
import * as pictures from './bad_gltf/pictures.mjs';
import * as scene from './bad_gltf/scene.mjs';

const [program, scratch, part = ''] = process.argv.slice(2);
const SLOWNESS = 'LSAN_OPTIONS' in process.env ? 5 : 1;  // of the sanitizers, in time and memory
const SECONDS = 10 * SLOWNESS, KILOBYTES = 1048576 * SLOWNESS;
const BAD_INPUT = 4;

// Cases that the program does not yet meet.
const wanted = new Set([]);

/** The bytes of a case's file. */
function makeFile(change) {
  const gltf = octahedron();
  const made = change(gltf);
  return typeof made === 'string' || Buffer.isBuffer(made) ? made : JSON.stringify(gltf);
}

const filesBelow = (folder) => readdirSync(folder, { recursive: true, withFileTypes: true }).filter((entry) => !entry.isDirectory());

/** A folder with the bad file, a good one, a recipe for both, and what the bad one's URIs are to reach or not. */
function makeFolder(name, change) {
  const folder = join(scratch, name.replaceAll(/[^A-Za-z0-9]/g, '-'), 'recipe');
  mkdirSync(folder, { recursive: true });
  writeFileSync(join(folder, '..', 'secret.bin'), Buffer.alloc(192));
  writeFileSync(join(folder, '..', 'secret.png'), 'no picture');
  symlinkSync(join(folder, '..', 'secret.bin'), join(folder, 'link.bin'));
  symlinkSync('..', join(folder, 'linked'));
  execFileSync('mkfifo', [join(folder, 'pipe.bin')]);
  writeFileSync(join(folder, 'short.bin'), Buffer.alloc(8));
  writeFileSync(join(folder, 'megabyte.bin'), Buffer.alloc(1 << 20));
  writeFileSync(join(folder, 'good.gltf'), JSON.stringify(octahedron()));
  writeFileSync(join(folder, 'bad.gltf'), makeFile(change));
  writeFileSync(join(folder, 'recipe.json'), JSON.stringify({
    version: 1, name: 'bad', sources: { good: 'good.gltf', bad: 'bad.gltf' },
    timeline: { tracks: [{ name: 'all', to: 'bad', begin: 0, end: 1 }] },
    outputs: [{ file: 'out/bad.glb' }],
  }));
  return folder;
}

const used = [];  // seconds, kilobytes, case

/** Runs the program; its exit code, what it said, and what is wrong with its end. */
function run(name, folder, words) {
  const measure = join(folder, '..', 'time.txt');
  const done = spawnSync('/usr/bin/time', ['-q', '-o', measure, '-f', '%e %M', program, ...words],
    { encoding: 'utf8', timeout: SECONDS * 1000, killSignal: 'SIGKILL', maxBuffer: 1 << 28 });
  if (done.error) return { ...done, problems: [`${words[0]}: ${done.error.code}`] };
  const [seconds, kilobytes] = readFileSync(measure, 'utf8').trim().split(' ').map(Number);
  used.push({ seconds, kilobytes, name: `${name} (${words[0]})` });
  const problems = [];
  if (seconds > SECONDS) problems.push(`${words[0]} took ${seconds} s`);
  if (kilobytes > KILOBYTES) problems.push(`${words[0]} took ${Math.round(kilobytes / 1024)} MiB`);
  if (![0, BAD_INPUT].includes(done.status)) problems.push(`${words[0]}: exit code ${done.status}`);
  return { ...done, problems };
}

const words = {
  bake: (folder) => ['bake', join(folder, 'recipe.json')],
  preview: (folder) => ['preview', join(folder, 'bad.gltf'), '--size', '16x16', '--frames', '2', '-o', join(folder, 'out/bad')],
  inspect: (folder) => ['inspect', join(folder, 'bad.gltf')],
};

/** Problems of one case: [] when all is as it must be. */
function check(name, command, [change, ...texts], mayBeRead) {
  const folder = makeFolder(name, change);
  const before = filesBelow(folder).length;
  const done = run(name, folder, words[command](folder));
  const problems = [...done.problems];
  if (done.status === 0 && mayBeRead) return problems;
  const said = mayBeRead ? ['[gltf.too-large]'] : texts;
  problems.push(...said.concat('bad.gltf').filter((text) => !done.stderr.includes(text))
    .map((text) => `stderr does not say ${JSON.stringify(text)}`));
  if (done.status === 0) problems.push('it was read');
  if (/[\x00-\x08\x0b-\x1f\x7f]/.test(done.stderr)) problems.push('stderr has control characters');
  if (done.stderr.length > 100000) problems.push(`stderr has ${done.stderr.length} characters`);
  if (filesBelow(folder).length !== before) problems.push('something was left behind');
  // What no bake reads, inspect may: it must end well, however it ends.
  if (command === 'bake') problems.push(...run(name, folder, words.inspect(folder)).problems);
  return problems.length ? [...problems, done.stderr.trim().slice(0, 2000)] : [];
}

const all = [
  ...[container, accessors, scene, packed, huge].flatMap((file) => Object.entries(file.baked).map((each) => [...each, 'bake', false])),
  ...[scene, pictures, huge].flatMap((file) => Object.entries(file.previewed).map((each) => [...each, 'preview', false])),
  ...[packed, pictures, huge].flatMap((file) => Object.entries(file.legal).map((each) => [...each, 'bake', true])),
];

rmSync(scratch, { recursive: true, force: true });
let passed = 0, failed = 0, skipped = 0;
for (const [name, definition, command, mayBeRead] of all.filter(([each]) => each.includes(part))) {
  const problems = check(name, command, definition, mayBeRead);
  rmSync(join(scratch, name.replaceAll(/[^A-Za-z0-9]/g, '-')), { recursive: true, force: true });
  const isWanted = wanted.has(name);
  if (isWanted && !problems.length) problems.push('is met: take it off the list of what is wanted');
  else if (isWanted) { ++skipped; console.log(`wanted ${name}`); continue; }
  console.log(`${problems.length ? 'FAILED' : 'ok    '} ${name}`);
  for (const problem of problems) console.log(`       ${problem}`);
  if (problems.length) ++failed; else ++passed;
}
const most = (field) => used.reduce((best, each) => (each[field] > best[field] ? each : best), { seconds: 0, kilobytes: 0, name: '' });
console.log(`slowest: ${most('seconds').seconds} s, ${most('seconds').name}`);
console.log(`largest: ${Math.round(most('kilobytes').kilobytes / 1024)} MiB, ${most('kilobytes').name}`);
console.log(`${passed} passed, ${failed} failed, ${skipped} skipped`);
process.exit(failed ? 1 : 0);
