// `morphbake batch` when things go wrong: limits, crashes, kills, interrupts, two at once, a full disk.
//
//   node batch_faults.mjs MORPHBAKE SCRATCH
import { spawn, spawnSync } from 'node:child_process';
import { existsSync, mkdirSync, readFileSync, writeFileSync } from 'node:fs';
import path from 'node:path';
import { bytesBelow, childrenOf, linesOf, sleep, until, writeMeshes, writeRecipe } from './batch_library.mjs';
import { filesBelow, startTesting } from './testing.mjs';

const [program, scratch] = process.argv.slice(2).map((each) => path.resolve(each));
const { check, run, finish } = startTesting(program, scratch);
const wordsOf = (words) => ['batch', ...words, '--cache', 'none', '-j', '2'];
const batch = (code, ...words) => run(code, wordsOf(words));
const start = (...words) => {
  const child = spawn(program, wordsOf(words), { stdio: ['ignore', 'pipe', 'pipe'] });
  const told = { stdout: '', stderr: '' };
  for (const name of ['stdout', 'stderr']) child[name].on('data', (text) => { told[name] += text; });
  const ended = new Promise((done) => child.on('close', (code, signal) => done({ code, signal, ...told })));
  return { pid: child.pid, kill: (signal) => child.kill(signal), ended };
};
const isAlive = (pid) => existsSync(`/proc/${pid}/stat`) && !/\) Z /.test(readFileSync(`/proc/${pid}/stat`, 'utf8'));
const states = (folder) => linesOf(`${folder}/report.jsonl`).map((line) => `${line.name} ${line.problems.find(({ severity }) => severity === 'error')?.code ?? line.state}`).sort().join();
const temporaries = (folder) => filesBelow(folder).filter((name) => name.includes('.tmp'));

writeMeshes('.');
for (let i = 0; i < 8; ++i) writeRecipe(`few/${i}.json`, { name: `m${i}` });
// Its thousand pictures take minutes.
const slow = { preview: { turntable: { size: [512, 512], frames: 1000 }, formats: ['gif'] } };
writeRecipe('slow/slow.json', slow);
writeFileSync('mixed.jsonl', '"few/1.json"\n"slow/slow.json"\n"few/2.json"\n');

// Time.
const timeout = batch(3, 'mixed.jsonl', '-o', 'timeout', '--timeout', '3');
check(states('timeout') === 'few/1 done,few/2 done,slow/slow batch.timeout', states('timeout'));
check(timeout.stderr.includes('slow/slow: it took more than 3 s'), timeout.stderr);
check(!existsSync('timeout/slow/slow'), 'a timeout leaves something');

// Memory.
function checkMemory() {
  mkdirSync('large');
  writeMeshes('large', 600);
  writeRecipe('large/in/large.json');
  writeFileSync('memory.jsonl', '"few/1.json"\n"large/in/large.json"\n"few/2.json"\n');
  const memory = batch(3, 'memory.jsonl', '-o', 'memory', '--memory', '0.15');
  check(states('memory') === 'few/1 done,few/2 done,large/in/large memory.exhausted', states('memory') + memory.stderr);
  check(memory.stderr.includes('--memory'), memory.stderr);
  check(temporaries('memory').length === 0, `left: ${temporaries('memory')}`);
  batch(0, 'memory.jsonl', '-o', 'memory', '--memory', '4');

  // However little memory: OpenBLAS must not ask for it without end.
  for (const gigabytes of ['0.001', '0.05', '0.1']) {
    const little = spawnSync(program, wordsOf(['memory.jsonl', '-o', `memory${gigabytes}`, '--memory', gigabytes]), { encoding: 'utf8', timeout: 60000 });
    check(little.status === 3 && states(`memory${gigabytes}`).includes('memory.exhausted'), `${gigabytes} GB: ${little.status} ${little.signal} ${little.stderr}`);
  }
}
if (process.env.LSAN_OPTIONS === undefined) checkMemory();
else console.log('skipped: limits of memory, of which AddressSanitizer itself needs terabytes');

// A file where a recipe's folder is to be stays as it is, as does what another recipe wrote there.
mkdirSync('taken');
writeFileSync('taken/m', 'of the user');
writeFileSync('taken.jsonl', '{"recipe": "few/1.json", "name": "m"}\n');
batch(3, 'taken.jsonl', '-o', 'taken');
check(readFileSync('taken/m', 'utf8') === 'of the user', 'a file of the user is gone');
writeFileSync('nested.jsonl', '{"recipe": "few/1.json", "name": "m"}\n{"recipe": "few/2.json", "name": "m/morph.glb"}\n');
batch(3, 'nested.jsonl', '-o', 'nested');
check(linesOf('nested/report.jsonl').filter(({ state }) => state === 'done').every(({ outputs }) => outputs.every(({ file }) => existsSync(path.join('nested', file)))), 'what is done is not there');

// A crash, and a kill from outside.
for (const [signal, text] of [['SIGUSR1', 'signal 10'], ['SIGKILL', 'run fewer at once']]) {
  const going = start('mixed.jsonl', '-o', `crash${signal}`);
  await until(() => existsSync(`crash${signal}/report.jsonl`) && linesOf(`crash${signal}/report.jsonl`).length === 2 && childrenOf(going.pid).length === 1);
  process.kill(childrenOf(going.pid)[0], signal);
  const { code, stderr } = await going.ended;
  check(code === 3 && stderr.includes(text) && stderr.includes('[batch.crashed]'), `${signal}: ${code} ${stderr}`);
  check(states(`crash${signal}`) === 'few/1 done,few/2 done,slow/slow batch.crashed', states(`crash${signal}`));
  check(!existsSync(`crash${signal}/slow/slow`), `${signal} leaves ${filesBelow(`crash${signal}/slow`)}`);
}

// Interrupts: the recipes stop, the report is kept.
for (const signal of ['SIGINT', 'SIGTERM']) {
  const going = start('mixed.jsonl', '-o', `stop${signal}`);
  await until(() => existsSync(`stop${signal}/report.jsonl`) && linesOf(`stop${signal}/report.jsonl`).length === 2 && childrenOf(going.pid).length === 1);
  const [child] = childrenOf(going.pid);
  going.kill(signal);
  const { code, stderr, stdout } = await going.ended;
  check(code === 130 && stdout === '' && stderr.includes('2 of 3 done; interrupted: the same command goes on'), `${signal}: ${code} ${stderr}`);
  check(!isAlive(child), `${signal}: a recipe goes on`);
  check(states(`stop${signal}`) === 'few/1 done,few/2 done' && temporaries(`stop${signal}`).length === 0, states(`stop${signal}`));
}

// Killed at any time, and gone on: the same bytes as undisturbed, and nothing besides.
batch(0, 'few/*.json', '-o', 'undisturbed');
let kills = 0;
for (let i = 0; i < 12; ++i) {
  const going = start('few/*.json', '-o', 'disturbed');
  await sleep(20 + 37 * i);
  const children = childrenOf(going.pid);
  going.kill('SIGKILL');
  const { signal } = await going.ended;
  kills += signal === 'SIGKILL';
  check(await until(() => !children.some(isAlive)), 'a recipe outlives the batch');
}
batch(0, 'few/*.json', '-o', 'disturbed');
check(kills > 2, `only ${kills} kills came in time`);
check(bytesBelow('disturbed') === bytesBelow('undisturbed'), `${bytesBelow('disturbed')} instead of ${bytesBelow('undisturbed')}`);
check(linesOf('disturbed/report.jsonl').length === 8, 'the report after kills');

// Two at once in one folder, of one list and of two.
for (const [folder, other] of [['twice', 'few/*.json'], ['both', 'few/[0-3].json']]) {
  const ends = await Promise.all([start('few/*.json', '-o', folder).ended, start(other, '-o', folder).ended]);
  check(ends.every(({ code }) => code === 0), `${folder}: ${ends.map(({ code, stderr }) => `${code} ${stderr}`)}`);
  check(linesOf(`${folder}/report.jsonl`).length === 8, `${folder}: ${linesOf(`${folder}/report.jsonl`).length} lines`);
  check(bytesBelow(folder) === bytesBelow('undisturbed'), `${folder}: other bytes`);
}

// A disk that is full: a small tmpfs, where one may be mounted.
mkdirSync('small');
if (spawnSync('mount', ['-t', 'tmpfs', '-o', 'size=40k', 'tmpfs', 'small']).status === 0) {
  const full = spawnSync(program, wordsOf(['few/*.json', '-o', 'small/out']), { encoding: 'utf8' });
  check([3, 6].includes(full.status) && full.stderr.includes('[output.unwritable]'), `full: ${full.status} ${full.stderr}`);
  check(temporaries('small').length === 0, `full: left ${temporaries('small')}`);
  check(linesOf('small/out/report.jsonl').every((line) => line.name && line.state), 'full: a torn report');
  spawnSync('mount', ['-o', 'remount,size=8m', 'small']);
  batch(0, 'few/*.json', '-o', 'small/out');
  check(bytesBelow('small/out') === bytesBelow('undisturbed'), 'full, and then not: other bytes');
  spawnSync('umount', ['small']);
} else {
  console.log('not tested: no tmpfs may be mounted here');
}
finish();
