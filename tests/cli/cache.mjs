// The cache: a bake with it gives the bytes of one without, and runs only what a change asks for.
//
//   node cache.mjs MORPHBAKE SCRATCH SHAPES
import { spawn } from 'node:child_process';
import { chmodSync, copyFileSync, cpSync, existsSync, mkdirSync, readFileSync, readdirSync, renameSync, rmSync, statSync, utimesSync, writeFileSync } from 'node:fs';
import path from 'node:path';
import { readGlb, writeGlb } from './glb.mjs';
import { filesBelow, startTesting } from './testing.mjs';

const [program, scratch, shapes] = process.argv.slice(2).map((each) => path.resolve(each));
const { check, run, finish } = startTesting(program, scratch);

mkdirSync('work');
for (const name of ['face', 'face_long_nose']) {
  for (const ending of ['.glb', '.landmarks.json']) copyFileSync(path.join(shapes, name + ending), path.join('work', name + ending));
}
const RECIPE = {
  version: 1,
  name: 'faces',
  sources: {
    face: 'face.glb',
    long: 'face_long_nose.glb',
    pulled: { edit: { of: 'face', region: 'nose', handles: [{ at: 'nose_tip', translate: [0, 0, 0.1] }] } },
  },
  connectivity: { mode: 'resample', target_edge_length: 0.04, sizing: 'uniform' },
  regions: {
    nose: { ball: { on: 'face', at: 'nose_tip', inner: 0.1, outer: 0.22 } },
    wave: { flood: { on: 'face', from: ['nose_tip'], softness: 0.2 } },
  },
  timeline: {
    fps: 8,
    tracks: [
      { name: 'grow', region: 'nose', to: 'long', begin: 0, end: 1 },
      { name: 'pull', region: 'nose', to: 'pulled', begin: 1, end: 2 },
    ],
  },
  outputs: [{ file: 'out/faces.glb' }, { file: 'out/still.glb', still: { at: 2 } }],
  preview: { turntable: { size: [64, 64], frames: 4 }, formats: ['gif', 'sheet'], maps: ['regions'] },
  options: { turntable: { samples: 1 } },
};
const CACHE = path.resolve('cache');
const ALL_OUTPUTS = ['output faces.glb', 'output still.glb', 'preview of faces.glb', 'preview of still.glb', 'maps'];
const BEFORE = ['connectivity', 'regions', 'derived sources', 'shapes'];
const copied = (change = () => {}) => { const recipe = structuredClone(RECIPE); change(recipe); return recipe; };
const written = (folder) => Object.fromEntries(filesBelow(folder).map((name) => [name, readFileSync(path.join(folder, name)).toString('base64')]));
const write = (recipe, file = 'work/recipe.json') => { writeFileSync(file, JSON.stringify(recipe)); return file; };

/** Bakes into an empty folder: what it wrote, and its report. */
function bake(file, cache, code = 0, ...words) {
  rmSync('out', { recursive: true, force: true });
  const done = run(code, ['bake', file, '-o', 'out', '--cache', cache, '--report', 'report.json', ...words]);
  return { files: written('out'), report: code === 0 && JSON.parse(readFileSync('report.json')), stderr: done.stderr };
}

/** The same bytes and the same report as without a cache, and from the cache just what is named. */
function checkBake(what, recipe, cached, file = 'work/recipe.json') {
  write(recipe, file);
  const { files, report } = bake(file, CACHE);
  const plain = bake(file, 'none');
  check(JSON.stringify(files) === JSON.stringify(plain.files) && Object.keys(files).length > 1, `${what}: other bytes than without a cache`);
  for (const each of [report, plain.report]) {
    delete each.stages;
    for (const step of each.connectivity.steps ?? []) delete step.seconds;
  }
  check(JSON.stringify(report.cached.toSorted()) === JSON.stringify(cached.toSorted()), `${what}: ${report.cached} from the cache, not ${cached}`);
  check(plain.report.cached.length === 0, `${what}: --cache none takes ${plain.report.cached}`);
  delete report.cached;
  delete plain.report.cached;
  check(JSON.stringify(report) === JSON.stringify(plain.report), `${what}: another report than without a cache`);
}

const planned = (...words) => JSON.parse(run(0, ['plan', 'work/recipe.json', '--json', '--cache', CACHE, ...words]).stdout);
const statesOf = (stages) => Object.fromEntries(stages.map(({ name, state }) => [name, state]));
const reasonFor = (stages, name) => stages.find((stage) => stage.name === name).reason ?? '';

// Nothing is there, then all is; and how the recipe is written does not matter, nor where it lies.
write(RECIPE);
check(Object.values(statesOf(planned())).every((state) => state === 'runs'), 'plans to take what is not there');
check(!planned('--preview', 'none').some(({ name }) => name.startsWith('preview') || name === 'maps'), 'plans pictures that nobody wants');
check(!existsSync(CACHE), 'planning writes');
checkBake('first', RECIPE, []);
checkBake('again', RECIPE, ['solve', ...ALL_OUTPUTS]);
const again = statesOf(planned());
check(again['output faces.glb'] === 'cached' && again.connectivity === 'unneeded' && again.solve === 'cached', JSON.stringify(again));
writeFileSync('work/recipe.json', JSON.stringify(RECIPE, null, 4));
check(bake('work/recipe.json', CACHE).report.cached.length === 6, 'white space matters');
cpSync('work', 'else where "ü"', { recursive: true });
checkBake('elsewhere', RECIPE, ['solve', ...ALL_OUTPUTS], 'else where "ü"/recipe.json');
check(bake('work/recipe.json', CACHE, 0, '--threads', '1').report.cached.length === 6, 'the number of threads matters');

// One change at a time: what must run, and why. Each starts from the recipe's own entries.
const changes = [
  ['a track ends later', (r) => { r.timeline.tracks[0].end = 0.5; }, BEFORE, '/timeline/tracks/0/end was 1 and is 0.5'],
  ['a track leads elsewhere', (r) => { r.timeline.tracks[1].to = { pulled: 0.5, face: 0.5 }; }, BEFORE.filter((name) => name !== 'shapes'), '/timeline/tracks/1/to was "pulled" and is {'],
  ['a region grows', (r) => { r.regions.nose.ball.outer = 0.25; }, ['connectivity'], '/regions/nose/ball/outer was 0.22 and is 0.25'],
  ['a region that nobody names', (r) => { r.regions.wave.flood.softness = 0.1; }, ['connectivity'], '/regions/wave/flood/softness'],
  ['a handle moves', (r) => { r.sources.pulled.edit.handles[0].translate[2] = 0.2; }, ['connectivity', 'regions'], '/derived/pulled/edit/handles/0/translate/2'],
  ['another resolution', (r) => { r.connectivity.target_edge_length = 0.05; }, [], 'the sources or the connectivity changed'],
  ['an option of the solver', (r) => { r.options.solve = { solver: 'direct' }; }, BEFORE.filter((name) => name !== 'shapes'), '/options/solve/solver'],
  ['targets of an output', (r) => { r.outputs[0].targets = 'frames'; }, [...BEFORE, 'output still.glb', 'preview of still.glb', 'maps'], ''],
  ['pictures', (r) => { r.preview.turntable.frames = 3; }, ['solve', 'output faces.glb', 'output still.glb', 'maps'], ''],
  ['the look of pictures', (r) => { r.options.turntable.azimuth = 10; }, [...BEFORE, 'output faces.glb', 'output still.glb'], ''],
  ['a region more', (r) => { r.regions.chin = { ball: { on: 'face', at: 'chin', inner: 0.05, outer: 0.1 } }; }, ['connectivity'], '/regions/chin is new'],
  ['names of files', (r) => { r.outputs[1].file = 'out/other.glb'; }, ['solve', 'output faces.glb', 'output other.glb', 'preview of faces.glb', 'preview of other.glb', 'maps'], ''],
];
for (const [what, change, cached, reason] of changes) {
  write(RECIPE);
  bake('work/recipe.json', CACHE);
  write(copied(change));
  const stages = planned();
  check(reason === '' || reasonFor(stages, 'solve').includes(reason) || false,
    `${what}: planned because "${reasonFor(stages, 'solve')}", not "${reason}"`);
  checkBake(what, copied(change), cached);
}
const explained = run(0, ['plan', 'work/recipe.json', '--explain', '--cache', CACHE]).stdout;
check(/^cached +.* s +solve$/m.test(explained), explained);

// The bytes of a source and of its landmarks count, its name does not.
write(RECIPE);
const glb = readGlb('work/face_long_nose.glb');
glb.json.asset.generator = 'another';
writeGlb('work/face_long_nose.glb', glb);
check(reasonFor(planned(), 'connectivity').includes('/sources/long has other bytes'), `a file's bytes: ${JSON.stringify(planned())}`);
checkBake('another file', RECIPE, []);
renameSync('work/face.glb', 'work/head.glb');
renameSync('work/face.landmarks.json', 'work/head.landmarks.json');
checkBake('a file of another name', copied((r) => { r.sources.face = 'head.glb'; }), ['solve', ...ALL_OUTPUTS]);
const landmarks = JSON.parse(readFileSync('work/head.landmarks.json'));
delete landmarks.landmarks[Object.keys(landmarks.landmarks).find((name) => name !== 'nose_tip')];
writeFileSync('work/head.landmarks.json', JSON.stringify(landmarks));
checkBake('other landmarks', copied((r) => { r.sources.face = 'head.glb'; }), []);

// Warnings are told again, in the words of whoever asks.
const warned = copied((r) => {
  r.sources = { face: 'head.glb', long: 'face_long_nose.glb' };
  r.timeline.tracks = [{ region: "nose", to: "face", begin: 0, end: 2 }];
});
checkBake('nothing moves', warned, ['connectivity', 'regions']);
cpSync('work', 'third', { recursive: true });
checkBake('nothing moves elsewhere', warned, ['solve', ...ALL_OUTPUTS], 'third/recipe.json');
check(/^third\/recipe\.json.*basis\.nothing-moves/m.test(bake('third/recipe.json', CACHE).stderr), 'the warning is not told, or of another file');

// Damaged entries are found and made again.
const entries = () => readdirSync(CACHE, { recursive: true }).filter((name) => name.endsWith('.entry')).map((name) => path.join(CACHE, name));
const whole = bake('third/recipe.json', CACHE);
const damages = {
  'cut off': (bytes) => bytes.subarray(0, bytes.length - 1),
  empty: () => Buffer.alloc(0),
  'a bit': (bytes) => { bytes[bytes.length >> 1] ^= 4; return bytes; },
  'no entry': () => Buffer.from('{}'),
};
for (const [what, damage] of Object.entries(damages)) {
  for (const file of entries()) writeFileSync(file, damage(readFileSync(file)));
  const mended = bake('third/recipe.json', CACHE);
  check(JSON.stringify(mended.files) === JSON.stringify(whole.files) && mended.report.cached.length === 0, `${what}: other bytes, or taken as whole`);
  check(mended.stderr.includes('[cache.damaged]') && mended.report.problems.some(({ code }) => code === 'cache.damaged'), `${what}: not told`);
  const after = bake('third/recipe.json', CACHE);
  check(after.report.cached.length === 6 && !after.stderr.includes('damaged'), `${what}: not made again`);
}

// A cache that cannot be written stops nobody.
writeFileSync('file', '');
const refused = bake('third/recipe.json', 'file');
check(JSON.stringify(refused.files) === JSON.stringify(whole.files), 'a file as cache: other bytes');
check(refused.report.problems.filter(({ code }) => code === 'cache.unwritable').length === 1, 'a file as cache: not told once');
const homeless = run(0, ['bake', 'third/recipe.json', '-o', 'out'], { HOME: '/nonexistent', MORPHBAKE_CACHE: '', XDG_CACHE_HOME: '' });
check(!homeless.stderr.includes('cache'), `warns of a cache that nobody asked for: ${homeless.stderr}`);
run(0, ['bake', 'third/recipe.json', '-o', 'out'], { HOME: path.resolve('home'), MORPHBAKE_CACHE: '', XDG_CACHE_HOME: '' });
check(filesBelow('home/.cache/morphbake').length > 5, 'does not keep in the home folder');
check(run(0, ['bake', 'third/recipe.json', '-o', 'out'], { MORPHBAKE_CACHE: CACHE }).stderr.includes('from the cache: solve'), 'MORPHBAKE_CACHE does nothing');

// What is used stays, the rest makes room.
rmSync(CACHE, { recursive: true });
bake('third/recipe.json', CACHE);
const old = entries();
for (const file of old) utimesSync(file, 1e9, 1e9);
bake('third/recipe.json', CACHE);
const used = old.filter((file) => statSync(file).mtimeMs > 1.1e12);
check(used.length >= 6 && used.length < old.length, `${used.length} of ${old.length} entries were used`);
const limit = 16 * Math.max(...entries().map((file) => statSync(file).size)) * 1.3 / 1e9;
for (let i = 0; i < 12; ++i) {
  write({ ...warned, timeline: { ...warned.timeline, duration: 2 + i } }, 'third/recipe.json');
  bake('third/recipe.json', CACHE, 0, '--cache-limit', String(limit));
}
const total = entries().reduce((sum, file) => sum + statSync(file).size, 0);
check(total <= limit * 1e9, `${total} bytes, more than ${limit * 1e9}`);
const told = run(0, ['cache', '--cache', CACHE]).stdout;
check(told.includes(`${entries().length} entries`), told);
writeFileSync(path.join(CACHE, 'mine.txt'), 'of the user');
const kept = entries().length;
const removed = run(0, ['cache', '--clear', '--cache', CACHE]).stdout;
check(removed.includes(`removed ${kept} entries`), removed);
check(entries().length === 0 && existsSync(path.join(CACHE, 'mine.txt')), 'clears too little or too much');

// Several bakes of one recipe at once, into one folder and one cache.
rmSync('out', { recursive: true, force: true });
const bakes = Array.from({ length: 4 }, () => new Promise((resolve) => {
  spawn(program, ['bake', 'work/recipe.json', '-o', 'out', '--cache', CACHE], { stdio: 'ignore' }).on('close', resolve);
}));
const codes = await Promise.all(bakes);
check(codes.every((code) => code === 0), `bakes at once end with ${codes}`);
const together = written('out');
check(JSON.stringify(together) === JSON.stringify(bake('work/recipe.json', 'none').files), 'bakes at once: other bytes, or files left over');
check(readdirSync(CACHE, { recursive: true }).every((name) => !path.basename(name).startsWith('.')), 'temporary files are left in the cache');
finish();
