// `morphbake batch` killed 200 times at random, with all its processes or alone, and gone on: the bytes of an undisturbed run.
//
//   node batch_kills.mjs MORPHBAKE SCRATCH [KILLS]
import { spawn } from 'node:child_process';
import path from 'node:path';
import { bytesBelow, childrenOf, linesOf, sleep, writeMeshes, writeRecipe } from './batch_library.mjs';
import { filesBelow, startTesting } from './testing.mjs';

const [program, scratch] = process.argv.slice(2, 4).map((each) => path.resolve(each));
const wanted = Number(process.argv[4] ?? 200);
const { check, run, finish } = startTesting(program, scratch);
const RECIPES = 100;
// Numbers that are as random as they need to be, and the same each time.
let seed = 1;
const random = () => (seed = (seed * 48271) % 2147483647) / 2147483647;

writeMeshes('.', 24);
for (let i = 0; i < RECIPES; ++i) {
  writeRecipe(`in/${i}.json`, { name: `m${i}`, timeline: { tracks: [{ name: 'all', to: 'egg', begin: 0, end: 1 + i / 100 }] } });
}
const words = (folder) => ['batch', 'in/*.json', '-o', folder, '-j', '3', '--cache', 'cache'];
run(0, ['batch', 'in/*.json', '-o', 'undisturbed', '--cache', 'none']);

let kills = 0, folder = 0, most = 0;
while (kills < wanted) {
  const child = spawn(program, words(`disturbed-${folder}`), { stdio: 'ignore' });
  const ended = new Promise((done) => child.on('close', (code) => done(code)));
  await sleep(150 + 400 * random());
  const recipes = childrenOf(child.pid);
  if (kills % 2) for (const pid of recipes) try { process.kill(pid, 'SIGKILL'); } catch { /* it has ended */ }
  child.kill('SIGKILL');
  const code = await ended;
  check(code === null || code === 0, `ends with ${code}`);
  if (code === 0) ++folder;
  kills += code === null;
  most = Math.max(most, recipes.length);
}
check(most > 1, 'no kill met a recipe');
for (let i = 0; i <= folder; ++i) {
  run(0, words(`disturbed-${i}`));
  check(bytesBelow(`disturbed-${i}`) === bytesBelow('undisturbed'), `disturbed-${i}: other bytes, or other files: ${filesBelow(`disturbed-${i}`).length}`);
  check(linesOf(`disturbed-${i}/report.jsonl`).length === RECIPES, `disturbed-${i}: the report`);
}
console.log(`${kills} kills, ${folder + 1} folders`);
finish();
