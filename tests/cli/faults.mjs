// Faults of the machine around a bake: each is told for what it is, and nothing is ever half-written.
//
//   node faults.mjs MORPHBAKE SCRATCH GOOD_RECIPE SHAPES
import { spawnSync } from 'node:child_process';
import { copyFileSync, cpSync, existsSync, mkdirSync, readFileSync, readdirSync, renameSync, symlinkSync, utimesSync, writeFileSync } from 'node:fs';
import path from 'node:path';
import { filesBelow, startTesting } from './testing.mjs';

const [program, scratch, recipe, shapes] = process.argv.slice(2).map((each) => path.resolve(each));
const { check, run, finish } = startTesting(program, scratch);
cpSync(path.dirname(recipe), 'good', { recursive: true });
const original = JSON.parse(readFileSync('good/recipe.json'));
// Pictures that fill a disk, but soon.
writeFileSync('good/recipe.json', JSON.stringify({ ...original, preview: { turntable: { size: [256, 256], frames: 60 }, formats: ['png'] }, options: { turntable: { samples: 1 } } }));
mkdirSync('large');
writeFileSync('large/recipe.json', JSON.stringify({
  version: 1, name: 'large', sources: { face: 'face.glb', long: 'long.glb' },
  regions: { nose: { ball: { on: 'face', at: { position: [0, 0, 0.1] }, inner: 0.1, outer: 0.5 } } },
  timeline: { fps: 40, tracks: [{ region: 'nose', to: 'long', begin: 0, end: 10 }] },
  outputs: [{ file: 'large.glb', targets: 'frames', encoding: 'float' }],
}));
copyFileSync(path.join(shapes, 'face.glb'), 'large/face.glb');
copyFileSync(path.join(shapes, 'face_long_nose.glb'), 'large/long.glb');
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
    check(!cache.stdout.includes('.tmp'), `a cache where nothing can be kept: ${cache.stdout}`);
    check(readFileSync('out/tetrahedra.glb').equals(right), 'a cache where nothing can be kept: other bytes');
  }
  const scratchFull = mounted(`mkdir -p tmp && mount -t tmpfs -o size=4k none tmp && TMPDIR=$PWD/tmp "$0" ${small('out', '--set', '/solve/every_frame=true').join(' ')}`);
  check(scratchFull.code === 0 || (scratchFull.code === 6 && scratchFull.stderr.includes('[output.unwritable]')), `a full folder of temporary files: ${scratchFull.code} ${scratchFull.stderr}`);
}

// Too little memory: wherever it ends, it is told, and nothing is left. Below 900 MB of addresses it ends in the loader.
function checkMemory() {
  const limits = [];
  for (let megabytes = 900; megabytes <= 1700; megabytes += 200) {
    const out = `bounded${megabytes}`;
    const bounded = spawnSync('bash', ['-c', `ulimit -v ${megabytes * 1024}; exec "$0" "$@"`, program, 'bake', 'large/recipe.json', '-o', out, '--cache', 'none'], { encoding: 'utf8', timeout: 120000 });
    limits.push(bounded.status);
    const left = filesBelow(out);
    if (bounded.status === 0) { check(left.length === 1, `${megabytes} MB: wrote ${left}`); continue; }
    check(left.length === 0, `${megabytes} MB: left ${left}`);
    check(/\[(memory\.exhausted|linear\.out-of-memory)\]/.test(bounded.stderr) && bounded.signal === null, `${megabytes} MB: ${bounded.status} ${bounded.signal} ${bounded.stderr}`);
  }
  check(limits[0] !== 0 && limits.at(-1) === 0, `exit codes by memory: ${limits}`);
}
if (process.env.LSAN_OPTIONS === undefined) checkMemory();
else console.log('skipped: limits of memory, of which AddressSanitizer itself needs terabytes');

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
  const stem = name.replaceAll('\n', ' ');  // a recipe may lie in any folder; in the names that it writes are no line breaks
  renameSync(path.join(name, 'tall.gltf'), path.join(name, `${stem}.gltf`));
  const named = JSON.parse(readFileSync(path.join(name, 'recipe.json')));
  named.sources.tall = `${stem}.gltf`;
  named.outputs[0].file = `${stem}/${stem}.glb`;
  delete named.preview;
  const file = `./${name}/${name}.json`;
  writeFileSync(file, JSON.stringify(named));
  for (const cache of ['named', 'named']) run(0, ['bake', file, '--cache', cache]);
  const folder = `${name}/${stem}`;
  check(existsSync(`${folder}/${stem}.glb`) && readFileSync(`${folder}/${stem}.glb`).equals(right), `${JSON.stringify(name)}: not written, or other bytes`);
  check(filesBelow(folder).length === 1, `${JSON.stringify(name)}: also ${filesBelow(folder)}`);
}

// Clocks that are wrong: files from the future, and from before there were clocks.
for (const seconds of [0, 4e9]) {
  for (const file of readdirSync('named', { recursive: true }).filter((each) => each.endsWith('.entry'))) utimesSync(path.join('named', file), seconds, seconds);
  for (const file of ['good/recipe.json', 'good/flat.gltf', 'good/tall.gltf']) utimesSync(file, seconds, seconds);
  const told = run(0, ['bake', 'good/recipe.json', '-o', 'out', '--preview', 'none', '--cache', 'named']);
  check(told.stderr.includes('from the cache') && readFileSync('out/tetrahedra.glb').equals(right), `files of the year ${seconds === 0 ? 1970 : 2096}`);
}

// As many entries as a recipe may have: a thousand regions and states, ten thousand keys.
const many = { ...original, preview: undefined, regions: {}, states: {}, timeline: { fps: 1, keys: [] } };
for (let i = 0; i < 10000; ++i) {
  if (i < 1000) {
    many.regions[`region ${i}`] = { ball: { on: 'flat', at: { vertex: i % 4 }, inner: 0.1, outer: 1 + i / 1000, distance: 'edges' } };
    many.states[`state ${i}`] = { mix: 'flat', edits: [{ region: `region ${i}`, to: 'tall', amount: (i % 10) / 10 }] };
  }
  many.timeline.keys.push({ time: i, state: `state ${i % 1000}` });
}
writeFileSync('good/many.json', JSON.stringify(many));
for (const words of [['validate', 'good/many.json'], ['plan', 'good/many.json', '--cache', 'none'], ['bake', 'good/many.json', '-o', 'many', '--cache', 'none']]) {
  const began = Date.now();
  run(0, words);
  console.log(`10,000 keys: ${words[0]} in ${(Date.now() - began) / 1000} s`);
}
many.timeline.keys.push({ time: 1e5, state: 'state 0' });
writeFileSync('good/many.json', JSON.stringify(many));
check(run(2, ['bake', 'good/many.json']).stderr.includes('2 to 10000 entries'), 'one entry more is not told');
finish();
