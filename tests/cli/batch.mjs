// `morphbake batch`: what it bakes, what it leaves as it is, what it tells.
//
//   node batch.mjs MORPHBAKE SCRATCH
import { cpSync, existsSync, mkdirSync, readFileSync, rmSync, statSync, utimesSync, writeFileSync } from 'node:fs';
import path from 'node:path';
import { bytesBelow, linesOf, recipe, writeMeshes, writeRecipe } from './batch_library.mjs';
import { filesBelow, startTesting } from './testing.mjs';

const [program, scratch] = process.argv.slice(2).map((each) => path.resolve(each));
const { check, run, finish } = startTesting(program, scratch);
const batch = (code, ...words) => run(code, ['batch', ...words, '--cache', 'none', '-j', '2']);
const before = (done) => Number(/(\d+) of them before/.exec(done.stderr)?.[1] ?? 0);
writeMeshes('.');

// A list with odd names, of which one fails and the others do not mind.
const ODD = ["it's \"odd\"\n", 'Näse 鼻 \u202e', 'a b & <c>', '%41#?'];
const names = ['plain', ...ODD];
for (const name of names) writeRecipe(`in/${name}.json`);
writeRecipe('in/broken.json', { sources: { ball: '../ball.gltf', egg: '../none.gltf' } });
const list = [...names, 'broken'].map((name) => `${name}.json`);
list.splice(2, 0, { recipe: 'plain.json', name: 'deep/er/twice', set: { '/timeline/tracks/0/end': 2, '/outputs/0/file': 'twice.glb' } });
writeFileSync('in/list.jsonl', list.map((line) => `${JSON.stringify(line)}\n`).join(''));

const first = batch(3, 'in/list.jsonl', '-o', 'out', '--html');
check(first.stdout === 'out/report.jsonl\nout/index.html\n', `prints ${first.stdout}`);
check(first.stderr.includes('broken: there is no file') && first.stderr.includes('6 of 7 done; 1 failed: out/failures.jsonl'), first.stderr);
const report = linesOf('out/report.jsonl');
const order = ['plain', ODD[0], 'deep/er/twice', ODD[1], ODD[2], ODD[3], 'broken'];
check(JSON.stringify(report.map((line) => line.name)) === JSON.stringify(order), `order: ${report.map((line) => line.name)}`);
check(report.every((line) => line.state === (line.name === 'broken' ? 'failed' : 'done')), JSON.stringify(report.map((line) => line.state)));
check(report[6].problems[0].code === 'recipe.missing-file', JSON.stringify(report[6]));
check(report[0].bake.vertices === 62 && report[0].bake.targets === 1 && report[0].bake.bytes > 1000, JSON.stringify(report[0].bake));
check(!existsSync('out/broken'), 'a failure leaves a folder');
check(filesBelow('out/deep/er/twice').join() === 'twice.glb', `outputs: ${filesBelow('out/deep')}`);
run(0, ['bake', 'in/plain.json', '-o', 'alone', '--cache', 'none']);
for (const name of names) check(readFileSync(`out/${name}/morph.glb`).equals(readFileSync('alone/morph.glb')), `${name}: other bytes than bake's`);
const page = readFileSync('out/index.html', 'utf8');
check(page.includes('a b &amp; &lt;c&gt;') && page.includes('%2541%23%3F/morph.glb') && !page.includes('<c>'), 'the page');
const failures = linesOf('out/failures.jsonl');
check(failures.length === 1 && failures[0].name === 'broken', 'failures.jsonl');

// Again: nothing but the failure is tried, the report is the same, and failures are a list themselves.
const glb = statSync('out/plain/morph.glb');
const again = batch(3, 'in/list.jsonl', '-o', 'out');
check(before(again) === 6 && statSync('out/plain/morph.glb').ino === glb.ino, `bakes again: ${again.stderr}`);
check(JSON.stringify(linesOf('out/report.jsonl').map((line) => line.name)) === JSON.stringify(order), 'the report has another order');
const retried = batch(3, 'out/failures.jsonl', '-o', 'out');
check(retried.stderr.includes('0 of 1 done'), retried.stderr);
check(linesOf('out/report.jsonl').length === 7, 'a list of failures drops what was done');
writeRecipe('in/broken.json');
check(before(batch(0, 'in/list.jsonl', '-o', 'out')) === 6, 'mended, not only that is baked');
check(readFileSync('out/failures.jsonl', 'utf8') === '', 'failures that are mended');

// What makes a difference, and what does not.
writeRecipe('in/one.json');
const one = (...words) => before(batch(0, 'in/one.json', '-o', 'one', ...words)) === 1;
check(!one() && one(), 'one recipe: the second time');
utimesSync('ball.gltf', new Date(), new Date());
check(one(), 'another time of a source');
utimesSync('in/one.json', new Date('2040-01-01'), new Date('2040-01-01'));
check(one() && one(), 'a time in the future');
writeFileSync('in/one.json', JSON.stringify(recipe(), null, 2));
check(one(), 'other spaces in a recipe');
writeFileSync('ball.landmarks.json', '{"version": 1, "landmarks": {"top": {"position": [0, 0, 1]}}}');
check(!one() && one(), 'landmarks that appear');
writeFileSync('ball.landmarks.json', '{"version": 1, "landmarks": {"top": {"position": [0, 1, 0]}}}');
check(!one(), 'landmarks of the same size');
rmSync('ball.landmarks.json');
check(!one(), 'landmarks that disappear');
const bin = readFileSync('egg.bin'), { atime, mtime } = statSync('egg.bin');
const egg = Buffer.from(bin);
egg.writeFloatLE(egg.readFloatLE(60) * 1.01, 60);
writeFileSync('egg.bin', egg);
utimesSync('egg.bin', atime, mtime);
check(!one(), 'a buffer with other bytes, of the same size and time');
writeFileSync('egg.bin', bin);
one();
check(!one('--set', '/basis/easing_tolerance=1e-4') && !one(), 'another option');
writeFileSync('one/one/morph.glb', 'other');
check(!one() && readFileSync('one/one/morph.glb').length > 1000, 'an output that was changed');
rmSync('one/one/morph.glb');
check(!one() && one(), 'an output that is gone');
writeRecipe('in/one.json', { outputs: [{ file: 'renamed.glb' }] });
check(!one() && filesBelow('one/one').join() === 'renamed.glb', `what is no output any more: ${filesBelow('one/one')}`);

// A torn report; a report of something else; a report that is a folder.
const whole = readFileSync('one/report.jsonl');
writeFileSync('one/report.jsonl', whole.subarray(0, whole.length - 20));
check(!one() && linesOf('one/report.jsonl').length === 1, 'a torn line');
writeFileSync('one/report.jsonl', Buffer.concat([Buffer.from('{}\nnull\n\x00\xff\n"x"\n'), readFileSync('one/report.jsonl')]));
check(one() && linesOf('one/report.jsonl').length === 1, 'lines of something else');
mkdirSync('bad/report.jsonl', { recursive: true });
check(batch(6, 'in/one.json', '-o', 'bad').stderr.includes('[output.unwritable]'), 'a report that is a folder');
writeFileSync('file', '');
batch(6, 'in/one.json', '-o', 'file');
batch(6, 'in/one.json', '-o', 'file/below');

// A table.
writeFileSync('lengths.csv', 'name,/timeline/tracks/0/end,/name\nshort,0.5,\nlong,4,"a ""long"" one"\n,late,\n');
const table = batch(3, 'in/one.json', '--table', 'lengths.csv', '-o', 'table');
check(table.stderr.includes('lengths.csv#/timeline/tracks/0/end:4:2: error: one-3: '), table.stderr);
check(linesOf('table/report.jsonl').map((line) => line.state).join() === 'done,done,failed', 'the states of a table');
check(linesOf('table/failures.jsonl')[0].set['/timeline/tracks/0/end'] === 'late', 'what a row sets');
writeFileSync('lengths.csv', 'name,/timeline/tracks/0/end\nshort,0.5\nlong,5\n');
check(before(batch(0, 'in/one.json', '--table', 'lengths.csv', '-o', 'table')) === 1, 'a row that was changed');

// A pattern, and shards that make up the whole.
for (let i = 0; i < 12; ++i) {
  const more = i % 2 ? { connectivity: { mode: 'resample', target_edge_length: 0.4 + 0.01 * (i >> 2), max_error: 0.1, max_vertices: 300 } } : {};
  writeRecipe(`library/${i}/recipe.json`, { sources: { ball: '../../ball.gltf', egg: '../../egg.gltf' }, ...more, name: `m${i}` });
}
batch(0, 'library/**/recipe.json', '-o', 'whole');
const shards = [1, 2, 3].map((shard) => {
  batch(0, 'library/**/recipe.json', '-o', 'parts', '--shard', `${shard}/3`);
  return linesOf(`parts/report.${shard}-of-3.jsonl`);
});
check(shards.flat().length === 12 && new Set(shards.flat().map((line) => line.name)).size === 12, `shards of ${shards.map((each) => each.length)}`);
check(bytesBelow('parts') === bytesBelow('whole'), 'shards give other bytes');
const shardOf = {};
shards.forEach((lines, i) => lines.filter((line) => Number(line.name.split('/')[0]) % 2).forEach((line) => {
  check((shardOf[line.connectivity] ??= i) === i, 'one connectivity in two shards');
}));
check(Object.keys(shardOf).length === 3, `connectivities: ${Object.keys(shardOf)}`);
check(before(batch(0, 'library/**/recipe.json', '-o', 'parts', '--shard', '2/3')) === shards[1].length, 'a shard again');
rmSync('parts/report.2-of-3.jsonl');
const missing = batch(3, 'library/**/recipe.json', '-o', 'parts', '--collect');
check(missing.stderr.includes('[batch.missing]') && linesOf('parts/failures.jsonl').length === shards[1].length, missing.stderr);
batch(0, 'library/**/recipe.json', '-o', 'parts', '--shard', '2/3');
const collected = batch(0, 'library/**/recipe.json', '-o', 'parts', '--collect', '--html');
check(collected.stdout === 'parts/report.jsonl\nparts/index.html\n', collected.stdout);
const sorted = (file) => linesOf(file).map((line) => `${line.name} ${line.key}`).join();
check(sorted('parts/report.jsonl') === sorted('whole/report.jsonl'), 'what is collected is not the whole');
check(before(batch(0, 'library/**/recipe.json', '-o', 'parts')) === 12, 'a whole run after shards');

// With a cache a connectivity is made once, also where several recipes that share it could start at once.
run(0, ['batch', 'library/**/recipe.json', '-o', 'shared', '--cache', 'cache', '-j', '4']);
const made = linesOf('shared/report.jsonl').filter((line) => Number(line.name.split('/')[0]) % 2 && !line.bake.cached.includes('connectivity'));
check(made.length === 3 && new Set(made.map((line) => line.connectivity)).size === 3, `made anew: ${made.map((line) => line.name)}`);
check(bytesBelow('shared') === bytesBelow('whole'), 'with a cache: other bytes');

// Wrong command lines and lists: told before anything is baked.
for (const [words, text] of [
  [['in/list.jsonl', '--shard', '4/3'], "--shard: '4/3'"], [['in/list.jsonl', '--shard', '1'], '--shard'],
  [['in/list.jsonl', '--shard', '1/2', '--collect'], '--collect'], [['in/list.jsonl', '--shard', '1/2', '--html'], '--html'],
  [['in/list.jsonl', '--set', '/no=1'], 'there is no option'], [['none.jsonl'], '[files.missing]'], [['in'], 'this is a folder'],
  [['in/list.jsonl', '--timeout', '-1'], '--timeout'], [['in/list.jsonl', '--table', 'lengths.csv'], 'of one recipe'],
  [['*.none'], '[batch.empty]'], [[], 'MANIFEST is required'],
]) check(batch(2, ...words, '-o', 'never').stderr.includes(text), `${words}: no "${text}"`);
check(!existsSync('never'), 'something is made for a wrong command line');
writeFileSync('bad.jsonl', '"in/plain.json"\n{"recipe": "in/plain.json", "name": "../up"}\n{"recipe" "in/one.json"}\n');
const bad = batch(2, 'bad.jsonl', '-o', 'never', '--log', 'json').stderr.trim().split('\n').map((line) => JSON.parse(line));
check(bad.map((each) => `${each.code} ${each.line}`).join() === 'batch.bad-name 2,json.syntax 3', JSON.stringify(bad));
writeFileSync('gone.jsonl', '"in/none.json"\n"in/plain.json"\n');
const gone = batch(3, 'gone.jsonl', '-o', 'gone', '--log', 'json').stderr.trim().split('\n').map((line) => JSON.parse(line));
check(gone.some((line) => line.batch?.done === 2 && line.batch.failed === 1 && line.batch.total === 2), JSON.stringify(gone));
check(linesOf('gone/report.jsonl').map((line) => line.problems[0]?.code).join() === 'files.missing,', 'a recipe that is not there');
finish();
