// Hostile glTF sources, each made here by one change to a good file, and what must be told of them.
//
//   node bad_gltf.mjs MORPHBAKE SCRATCH [PART OF A NAME]
//
// Every case must end with exit code 4 within 10 s (of the processor: other tests run beside) and 1 GiB, name the file,
// the place and the code, and leave no output behind. Legal files that are huge may also be read.
import { execFile, execFileSync } from 'node:child_process';
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
const SECONDS = 10 * SLOWNESS, WALL_SECONDS = 6 * SECONDS, KILOBYTES = 1048576 * SLOWNESS;
const BAD_INPUT = 4;
const TOO_MUCH = /\[gltf\.(too-large|json-too-many-values)\]/;

/** The bytes of a case's file. */
function makeFile(change) {
  const gltf = octahedron();
  const made = change(gltf);
  return typeof made === 'string' || Buffer.isBuffer(made) ? made : JSON.stringify(gltf);
}

const filesBelow = (folder) => readdirSync(folder, { recursive: true, withFileTypes: true }).filter((entry) => !entry.isDirectory());

const folderOf = (name) => join(scratch, name.replaceAll(/[^A-Za-z0-9]/g, '-'));

/** A folder with the bad file, a good one, a recipe for both, and what the bad one's URIs are to reach or not. */
function makeFolder(name, change, choice) {
  const folder = join(folderOf(name), 'recipe');
  mkdirSync(folder, { recursive: true });
  writeFileSync(join(folder, '..', 'secret.bin'), Buffer.alloc(192));
  writeFileSync(join(folder, '..', 'secret.png'), 'no picture');
  symlinkSync(join(folder, '..', 'secret.bin'), join(folder, 'link.bin'));
  symlinkSync('..', join(folder, 'linked'));
  execFileSync('mkfifo', [join(folder, 'pipe.bin')]);
  writeFileSync(join(folder, 'short.bin'), Buffer.alloc(8));
  writeFileSync(join(folder, 'empty.jpg'), '');
  writeFileSync(join(folder, 'megabyte.bin'), Buffer.alloc(1 << 20));
  writeFileSync(join(folder, 'good.gltf'), JSON.stringify(octahedron()));
  writeFileSync(join(folder, 'bad.gltf'), makeFile(change));
  // The bad file is the first source, of which everything is kept and written.
  writeFileSync(join(folder, 'recipe.json'), JSON.stringify({
    version: 1, name: 'bad',
    sources: { bad: choice ? { file: 'bad.gltf', ...choice } : 'bad.gltf', good: 'good.gltf' },
    timeline: { tracks: [{ name: 'all', to: 'good', begin: 0, end: 1 }] },
    outputs: [{ file: 'out/bad.glb' }],
  }));
  return folder;
}

const used = [];  // seconds, kilobytes, case

/** Calls a program by /usr/bin/time, which ends with its exit code; what it said. */
const measured = (file, words) => new Promise((resolve) => {
  // timeout ends a process that hangs, where ending `time` would leave it; prlimit spares the machine.
  const limits = ['timeout', '-s', 'KILL', String(WALL_SECONDS), ...(SLOWNESS > 1 ? [] : ['prlimit', `--as=${4 * 2 ** 30}`])];
  const command = ['-o', file, '-f', '%U %S %M', ...limits, program, ...words];
  execFile('/usr/bin/time', command, { maxBuffer: 1 << 28 }, (error, stdout, stderr) =>
    resolve({ status: error ? (error.code ?? error.signal) : 0, stderr }));
});

/** Runs the program; its exit code, what it said, and what is wrong with its end. */
async function run(name, folder, words, codes = [0, BAD_INPUT]) {
  const measure = join(folder, '..', 'time.txt');
  const done = await measured(measure, words);
  const [user, system, kilobytes] = readFileSync(measure, 'utf8').trim().split('\n').pop().split(' ').map(Number);
  const seconds = user + system;
  used.push({ seconds, kilobytes, name: `${name} (${words[0]})` });
  const problems = [];
  if (seconds > SECONDS) problems.push(`${words[0]} took ${seconds.toFixed(1)} s`);
  if (kilobytes > KILOBYTES) problems.push(`${words[0]} took ${Math.round(kilobytes / 1024)} MiB`);
  if (!codes.includes(done.status) || done.stderr.includes('[bug.')) problems.push(`${words[0]}: exit code ${done.status}`);
  return { ...done, problems };
}

const words = {
  bake: (folder) => ['bake', join(folder, 'recipe.json')],
  preview: (folder) => ['preview', join(folder, 'bad.gltf'), '--size', '16x16', '--frames', '2', '-o', join(folder, 'out/bad')],
  inspect: (folder) => ['inspect', join(folder, 'bad.gltf')],
  lint: (folder) => ['lint', join(folder, 'bad.gltf'), '--profile', 'spec-min'],
  diff: (folder) => ['diff', join(folder, 'bad.gltf'), join(folder, 'bad.gltf')],
};

/** Problems of one case: [] when all is as it must be. */
async function check(name, command, [change, ...texts], { choice, mayBeRead = false, mustBeRead = false, inspected = false, isWarning = false }) {
  const folder = makeFolder(name, change, choice);
  const before = filesBelow(folder).length;
  const done = await run(name, folder, words[command](folder));
  const problems = [...done.problems];
  if (mustBeRead && done.status !== 0) return [...problems, 'it was refused', done.stderr.slice(0, 2000)];
  if (done.status === 0 && (mayBeRead || mustBeRead)) return problems;
  // Of two sources that differ the second is named, and a picture shows where.
  const differs = texts.some((text) => text.includes('connectivity.'));
  const names = differs ? 'good.gltf' : 'bad.gltf';
  problems.push(...texts.concat(names).filter((text) => !done.stderr.includes(text))
    .map((text) => `stderr does not say ${JSON.stringify(text)}`));
  if ((done.status === 0) !== isWarning) problems.push(isWarning ? 'it was refused' : 'it was read');
  // What is wrong in the JSON is told with its place; a container has none.
  if (done.stderr.includes('[gltf.invalid]') && !done.stderr.includes('bad.gltf#/') && !name.startsWith('glb with')) problems.push('no place is named');
  if (mayBeRead && !TOO_MUCH.test(done.stderr)) problems.push('it was refused, and not for its size');
  if (/[\x00-\x08\x0b-\x1f\x7f]/.test(done.stderr)) problems.push('stderr has control characters');
  if (done.stderr.length > 100000) problems.push(`stderr has ${done.stderr.length} characters`);
  if (!isWarning && filesBelow(folder).filter(({ name }) => !differs || !name.endsWith('.png')).length !== before) problems.push('something was left behind');
  if (inspected) {
    problems.push(...(await run(name, folder, words.inspect(folder))).problems);
    problems.push(...(await run(name, folder, words.lint(folder), [0, 1, 2])).problems);
    problems.push(...(await run(name, folder, words.diff(folder), [0, 1, 2])).problems);
  }
  return problems.length ? [...problems, done.stderr.trim().slice(0, 2000)] : [];
}

const cases = (files, kind, command, rules = {}) =>
  files.flatMap((file) => Object.entries(file[kind]).map(([name, definition]) => ({ name, definition, command, rules })));

const all = [
  ...cases([container, packed], 'baked', 'bake'),
  // Inspect, lint and diff read more of a file than a bake does: they must end well, however they end.
  ...cases([accessors, scene, huge], 'baked', 'bake', { inspected: true }),
  ...Object.entries(scene.chosen).map(([name, [choice, ...definition]]) => ({ name, definition, command: 'bake', rules: { choice } })),
  ...Object.entries(huge.chosen).map(([name, [choice, ...definition]]) => ({ name, definition, command: 'bake', rules: { choice, mayBeRead: true } })),
  ...cases([scene, pictures, huge], 'previewed', 'preview'),
  ...cases([pictures], 'warned', 'preview', { isWarning: true }),
  ...cases([accessors, packed, huge], 'legal', 'bake', { mayBeRead: true }),
  ...cases([pictures], 'legal', 'preview', { mayBeRead: true }),
  ...cases([huge], 'read', 'bake', { mustBeRead: true }),
].filter(({ name }) => name.includes(part));

let passed = 0, failed = 0;

async function checkNext() {
  for (let next = all.shift(); next; next = all.shift()) {
    const { name, definition, command, rules } = next;
    const problems = await check(name, command, definition, rules);
    rmSync(folderOf(name), { recursive: true, force: true });
    console.log([`${problems.length ? 'FAILED' : 'ok    '} ${name}`, ...problems].join('\n       '));
    if (problems.length) ++failed; else ++passed;
  }
}

rmSync(scratch, { recursive: true, force: true });
await Promise.all([checkNext(), checkNext()]);  // half of a start is waiting for libraries
const most = (field) => used.reduce((best, each) => (each[field] > best[field] ? each : best));
console.log(`slowest: ${most('seconds').seconds.toFixed(1)} s, ${most('seconds').name}`);
console.log(`largest: ${Math.round(most('kilobytes').kilobytes / 1024)} MiB, ${most('kilobytes').name}`);
console.log(`${passed} passed, ${failed} failed`);
process.exit(failed ? 1 : 0);
