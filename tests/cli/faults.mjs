// Faults of the machine around a bake: each is told for what it is, and nothing is ever half-written.
//
//   node faults.mjs MORPHBAKE SCRATCH GOOD_RECIPE
import { spawnSync } from 'node:child_process';
import { cpSync, existsSync, mkdirSync, readFileSync, readdirSync, renameSync, symlinkSync, utimesSync, writeFileSync } from 'node:fs';
import path from 'node:path';
import { filesBelow, startTesting } from './testing.mjs';

const [program, scratch, recipe] = process.argv.slice(2).map((each) => path.resolve(each));
const { check, run, finish } = startTesting(program, scratch);
cpSync(path.dirname(recipe), 'good', { recursive: true });
const small = (out, ...words) => ['bake', 'good/recipe.json', '-o', out, '--preview', 'none', '--cache', 'none', ...words];
run(0, small('right'));
const right = readFileSync('right/tetrahedra.glb');

/** Runs a shell script with mounts of its own, in which "$0" is the program. */
function mounted(script) {
  const done = spawnSync('unshare', ['-rm', 'bash', '-c', script, program], { encoding: 'utf8' });
  return { code: done.status, stdout: done.stdout ?? '', stderr: done.stderr ?? '' };
}
const canMount = mounted('mkdir -p probe && mount -t tmpfs none probe').code === 0;
if (!canMount) console.log('SKIPPED: full and read-only disks, since mounts are not allowed here');

/** A bake into a folder that `mount` makes: its exit code, what it told, and what is left there. */
function bakeInto(mount, words) {
  return mounted(`mkdir -p disk && ${mount} && { "$0" ${words}; code=$?; echo "left: $(find disk -type f | tr '\\n' ' ')"; exit $code; }`);
}
if (canMount) {
  // 12 KB are three pages; the file has more.
  const full = bakeInto('mount -t tmpfs -o size=12k none disk', 'bake good/recipe.json -o disk/out --preview none --cache none --set /solve/every_frame=true');
  check(full.code === 6 && full.stderr.includes('[output.unwritable]') && full.stderr.includes('No space left on device'), `a full disk: ${full.code} ${full.stderr}`);
  check(full.stdout.trim() === 'left:', `a full disk: ${full.stdout}`);
  const gif = bakeInto('mount -t tmpfs -o size=200k none disk', 'bake good/recipe.json -o disk/out --cache none');
  check(gif.code === 6 && gif.stderr.includes('No space left on device') && gif.stdout.trim() === 'left:', `a disk that pictures fill: ${gif.code} ${gif.stderr}${gif.stdout}`);
  const readOnly = bakeInto('mount -t tmpfs -o ro none disk', 'bake good/recipe.json -o disk/out --preview none --cache none');
  check(readOnly.code === 6 && readOnly.stderr.includes('Read-only file system'), `a read-only disk: ${readOnly.code} ${readOnly.stderr}`);
  for (const mount of ['mount -t tmpfs -o size=4k none disk', 'mount -t tmpfs -o ro none disk']) {
    const cache = bakeInto(mount, 'bake good/recipe.json -o out --preview none --cache disk/cache');
    check(cache.code === 0 && cache.stderr.includes('[cache.unwritable]'), `a cache where nothing can be kept: ${cache.code} ${cache.stderr}`);
    check(cache.stdout.trim().endsWith('left:'), `a cache where nothing can be kept: ${cache.stdout}`);
    check(readFileSync('out/tetrahedra.glb').equals(right), 'a cache where nothing can be kept: other bytes');
  }
  const scratchFull = mounted(`mkdir -p tmp && mount -t tmpfs -o size=4k none tmp && TMPDIR=$PWD/tmp "$0" ${small('out', '--set', '/solve/every_frame=true').join(' ')}`);
  check(scratchFull.code === 0 || (scratchFull.code === 6 && scratchFull.stderr.includes('[output.unwritable]')), `a full folder of temporary files: ${scratchFull.code} ${scratchFull.stderr}`);
}

// Too little memory: at whatever allocation it ends, it is told, and nothing is left.
const limits = [];
for (let megabytes = 700; megabytes <= 2500; megabytes += 150) {
  const bounded = spawnSync('bash', ['-c', `ulimit -v ${megabytes * 1024}; exec "$0" "$@"`, program, 'bake', 'good/recipe.json', '-o', `bounded${megabytes}`, '--cache', 'none'], { encoding: 'utf8', timeout: 120000 });
  limits.push(bounded.status);
  const left = filesBelow(`bounded${megabytes}`);
  if (bounded.status === 0) { check(left.length === 2, `${megabytes} MB: wrote ${left}`); continue; }
  check(left.length === 0, `${megabytes} MB: left ${left}`);
  // Below what the program's libraries need, the loader tells.
  const isTold = bounded.stderr.includes('[memory.exhausted]') || bounded.stderr.includes('error while loading shared libraries') || bounded.stderr.includes('[linear.out-of-memory]');
  check(isTold && bounded.signal === null, `${megabytes} MB: ${bounded.status} ${bounded.signal} ${bounded.stderr}`);
}
console.log(`exit codes by memory: ${limits}`);

// Links that lead round in circles.
symlinkSync('b', 'a');
symlinkSync('a', 'b');
const looped = JSON.parse(readFileSync('good/recipe.json'));
writeFileSync('good/looped.json', JSON.stringify({ ...looped, sources: { ...looped.sources, flat: '../a' } }));
check(run(2, ['bake', 'good/looped.json', '-o', 'out']).stderr.includes('[recipe.missing-file]'), 'a source that is a circle of links');
check(run(2, ['bake', 'a', '-o', 'out']).stderr.includes('[files.missing]'), 'a recipe that is a circle of links');
check(run(6, small('a')).stderr.includes('[output.unwritable]'), 'a folder that is a circle of links');
check(run(0, ['bake', 'good/recipe.json', '-o', 'out', '--preview', 'none', '--cache', 'a']).stderr.includes('[cache.unwritable]'), 'a cache that is a circle of links');
symlinkSync('.', 'good/self');
check(run(0, ['bake', 'good/self/self/self/recipe.json', '-o', 'out', '--preview', 'none']).status === 0, 'a folder that links to itself');

// Names as people give them.
for (const name of ['a space', 'quotes \' " `$(x)`', 'two\nlines', 'Käse größe', '頂点 モーフ', '-dash', 'percent %20 #?&', 'e\u0301motion']) {
  cpSync('good', name, { recursive: true, filter: (file) => !file.endsWith('self') });
  renameSync(path.join(name, 'tall.gltf'), path.join(name, `${name}.gltf`));
  const named = JSON.parse(readFileSync(path.join(name, 'recipe.json')));
  named.sources.tall = `${name}.gltf`;
  named.outputs[0].file = `${name}/${name}.glb`;
  delete named.preview;
  const file = `./${name}/${name}.json`;
  writeFileSync(file, JSON.stringify(named));
  for (const cache of ['named', 'named']) run(0, ['bake', file, '--cache', cache]);
  check(existsSync(`${name}/${name}/${name}.glb`) && readFileSync(`${name}/${name}/${name}.glb`).equals(right), `${JSON.stringify(name)}: not written, or other bytes`);
  check(filesBelow(`${name}/${name}`).length === 1, `${JSON.stringify(name)}: also ${filesBelow(`${name}/${name}`)}`);
}

// Clocks that are wrong: files from the future, and from before there were clocks.
for (const seconds of [0, 4e9]) {
  for (const file of readdirSync('named', { recursive: true }).filter((each) => each.endsWith('.entry'))) utimesSync(path.join('named', file), seconds, seconds);
  for (const file of ['good/recipe.json', 'good/flat.gltf', 'good/tall.gltf']) utimesSync(file, seconds, seconds);
  const told = run(0, ['bake', 'good/recipe.json', '-o', 'out', '--preview', 'none', '--cache', 'named']);
  check(told.stderr.includes('from the cache') && readFileSync('out/tetrahedra.glb').equals(right), `files of the year ${seconds === 0 ? 1970 : 2096}`);
}

// Ten thousand of everything that a recipe lists.
const many = JSON.parse(readFileSync('good/recipe.json'));
delete many.preview;
many.regions = {};
many.states = {};
many.timeline.keys = [];
for (let i = 0; i < 10000; ++i) {
  many.regions[`region ${i}`] = { ball: { on: 'flat', at: { vertex: i % 4 }, inner: 0.1, outer: 1 + i / 10000, distance: 'edges' } };
  many.states[`state ${i}`] = { mix: 'flat', edits: [{ region: `region ${i}`, to: 'tall', amount: (i % 10) / 10 }] };
  many.timeline.keys.push({ time: i / 10, state: `state ${i}` });
}
writeFileSync('good/many.json', JSON.stringify(many));
const began = Date.now();
run(0, ['validate', 'good/many.json']);
run(0, ['plan', 'good/many.json', '--cache', 'none']);
console.log(`a recipe of 10,000 regions, states and keys: checked and planned in ${(Date.now() - began) / 1000} s`);
finish();
