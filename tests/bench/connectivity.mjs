// node connectivity.mjs PROGRAM HELPER MESHES DOCS COMMAND: measures `morphbake remesh` on real
// meshes, writes DOCS/connectivity-measured.md, .json and the sheets in DOCS/connectivity.
import { execFileSync, spawnSync } from 'node:child_process';
import { mkdirSync, mkdtempSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { cpus, tmpdir } from 'node:os';
import { basename, join } from 'node:path';

import { catTailTip, copyRemark, credits, fourRemark, pairs, penguinEars, penguinNames, tailRemark } from './connectivity_cases.mjs';

const [program, helper, meshes, docs, command] = process.argv.slice(2);
const scratch = mkdtempSync(join(tmpdir(), 'morphbake-bench-'));
process.on('exit', () => rmSync(scratch, { recursive: true, force: true }));
const connectivity = { mode: 'remesh', max_error: 0.002, max_vertices: 30000 };

const help = (...words) => execFileSync(helper, words, { encoding: 'utf8', maxBuffer: 1 << 26 });
const readPair = (name) => JSON.parse(readFileSync(join(meshes, `pair-${name}.json`), 'utf8'));
const stem = (file) => basename(file, '.glb');

/** A source of a recipe from one side of a pair; `names` renames landmarks and leaves the others out. */
function side(pair, which, names) {
  const landmarks = {};
  for (const landmark of pair.landmarks) {
    const name = names ? names[landmark.name] : landmark.name;
    if (name) landmarks[name] = { position: landmark[which] };
  }
  return { file: join(meshes, pair[which]), landmarks };
}

/** A recipe whose sources are brought onto the first one. */
function writeRecipe(name, sources) {
  const file = join(scratch, `${name}.json`);
  const [first, ...others] = Object.entries(sources);
  const aligned = others.map(([each, source]) => [each, { ...(source.file ? source : { file: source }), align: 'similarity' }]);
  const timeline = { tracks: [{ to: others.at(-1)[0], begin: 0, end: 1 }] };
  const recipe = { version: 1, name, sources: Object.fromEntries([first, ...aligned]), connectivity, timeline };
  writeFileSync(file, JSON.stringify(recipe));
  return file;
}

/** Pictures of the morph through all sources and back, from the files in `folder` that `remesh` wrote. */
function drawMorph(name, names, folder) {
  const file = join(folder, 'morph.json');
  const keys = names.map((state, time) => ({ time, state, ease: 'smoothstep' }));
  const sources = Object.fromEntries(names.map((each) => [each, join(folder, `${each}.glb`)]));
  const preview = { turntable: { size: [200, 200], frames: 12 }, formats: ['sheet'] };
  writeFileSync(file, JSON.stringify({ version: 1, name: 'morph', sources, timeline: { keys }, preview }));
  execFileSync(program, ['bake', file, '-o', folder, '--quiet'], { stdio: ['ignore', 'ignore', 'inherit'] });
  help('shrink', join(folder, 'morph.sheet.png'), join(docs, 'connectivity', `${name}.morph.png`), '600');
}

/** What the tables need of a report: the seconds are those of making the triangles. */
function measures(report) {
  const { vertices, sources, distortion, distorted_regions: regions, steps } = JSON.parse(report).connectivity;
  const making = ['surfaces', 'sphere', 'triangulate', 'carry', 'project'];
  const seconds = steps.filter((step) => making.includes(step.name)).reduce((sum, step) => sum + step.seconds, 0);
  return { vertices, seconds, sources, distortion, regions };
}

/** Runs `morphbake remesh`: its report, wall seconds and peak memory, or why it failed. */
function remesh(name, sources, sheet) {
  console.error(`bench: ${name}`);
  const recipe = writeRecipe(name, sources);
  const folder = join(scratch, name);
  const report = join(folder, 'report.json');
  const words = ['remesh', recipe, '-o', folder, '--report', report, '--sheet', sheet ? 'png' : 'none'];
  const run = spawnSync('/usr/bin/time', ['-f', '%e %M', program, ...words], { encoding: 'utf8', maxBuffer: 1 << 26 });
  if (run.status !== 0) {
    return { name, failed: run.stderr.split('\n').find((line) => line.includes('error:')) ?? run.stderr };
  }
  const [wall, peak] = run.stderr.trim().split('\n').at(-1).split(' ').map(Number);
  const made = measures(readFileSync(report, 'utf8'));
  if (sheet) {
    const width = Object.keys(sources).length > 2 ? '560' : '760';
    help('shrink', join(folder, `${name}.connectivity.png`), join(docs, 'connectivity', `${name}.png`), width);
    drawMorph(name, Object.keys(sources), folder);
  }
  return { name, wall, peak_mb: peak / 1024, ...made };
}

/** A case for the tables of quality: the remesh and the plainest alternative. */
function compare(name, sources, remark) {
  const made = remesh(name, sources, true);
  const projected = measures(help('project', writeRecipe(name, sources)));
  return { ...made, remark, projected };
}

function copies(file, count, edge) {
  help('copy', file, scratch, String(count), String(edge));
  return Object.fromEntries([...Array(count).keys()].map((i) => [`copy${i}`, join(scratch, `${stem(file)}_${i}.glb`)]));
}

/** Both sources of a pair with their edges halved `levels` times. */
function finer(pair, levels) {
  const sources = {};
  for (const which of ['a', 'b']) {
    const { file, landmarks } = side(pair, which);
    const copy = join(scratch, `${stem(file)}.glb`);
    writeFileSync(copy, readFileSync(file));
    writeFileSync(join(scratch, `${stem(file)}.landmarks.json`), JSON.stringify({ version: 1, landmarks }));
    help('finer', copy, scratch, String(levels));
    sources[stem(file)] = join(scratch, `${stem(file)}_0.glb`);
  }
  return sources;
}

function fourAnimals() {
  const cat = readPair('cat--spot');
  const same = Object.fromEntries(cat.landmarks.map((landmark) => [landmark.name, landmark.name]));
  const penguin = side(readPair('penguin--mh_male_baby'), 'a', penguinNames);
  for (const [name, position] of Object.entries(penguinEars)) penguin.landmarks[name] = { position };
  return { cat: side(cat, 'a'), spot: side(cat, 'b'), koala: side(readPair('koala--spot'), 'a', same), penguin };
}

function measureQuality() {
  const cases = pairs.map(({ file, remark }) => {
    const pair = readPair(file);
    return compare(file, { [stem(pair.a)]: side(pair, 'a'), [stem(pair.b)]: side(pair, 'b') }, remark);
  });
  const tails = readPair('cat--spot');
  const marked = tails.landmarks.map((mark) => (mark.name === 'tail_base' ? { ...mark, name: 'tail_tip', a: catTailTip } : mark));
  cases.push(compare('cat--spot-tail', { cat: side({ ...tails, landmarks: marked }, 'a'), spot: side({ ...tails, landmarks: marked }, 'b') }, tailRemark));
  const wingnut = copies(join(meshes, 'wingnut.glb'), 2, 0.01);
  cases.push(compare('wingnut--copy', { wingnut: wingnut.copy0, copy: wingnut.copy1 }, copyRemark));
  cases.push(compare('four', fourAnimals(), fourRemark));
  return cases;
}

function measureTime() {
  const pair = readPair('koala--spot');
  const cat = side(readPair('cat--spot'), 'a');
  const marked = join(scratch, 'cat.glb');
  writeFileSync(marked, readFileSync(cat.file));
  writeFileSync(join(scratch, 'cat.landmarks.json'), JSON.stringify({ version: 1, landmarks: cat.landmarks }));
  const eight = copies(marked, 8, 0);
  const two = Object.fromEntries(Object.entries(eight).slice(0, 2));
  return [
    { title: 'two sources of 11.7k and 14.2k vertices (spot and koala, edges halved)', ...remesh('two-12k', finer(pair, 1)) },
    { title: 'two sources of 47k and 57k vertices (the same, halved twice)', ...remesh('two-50k', finer(pair, 2)) },
    { title: '2 sources of 7.9k vertices (cat, bent)', ...remesh('cats-2', two) },
    { title: '8 sources of 7.9k vertices (cat, bent)', ...remesh('cats-8', eight) },
  ];
}

const percent = (fraction) => (100 * fraction).toFixed(3);
const short = (value) => (value >= 1e4 ? value.toExponential(1) : value >= 100 ? value.toFixed(0) : value.toFixed(2));

function rows(name, way, { vertices, sources, distortion, seconds }) {
  return sources.map((source, s) => {
    const map = distortion.find((other) => other.source === source.source);
    const stretch = map ? [map.mean, map.median, map.percentile_99, map.maximum].map(short).join(' / ') : '';
    const cells = s === 0 ? [name, way, vertices, seconds.toFixed(seconds < 1 ? 2 : 1)] : ['', '', '', ''];
    const distances = `${percent(source.source_to_remesh)} / ${percent(source.remesh_to_source)}`;
    const cuts = `${source.new_self_intersections} (${source.source_self_intersections})`;
    return `| ${[...cells, source.source, distances, stretch, source.smallest_angle.toFixed(1), source.folds, cuts,
      percent(source.landmark_error)].join(' | ')} |`;
  });
}

function qualityTable(cases) {
  const lines = [
    '| case | way | vertices | s | source | Hausdorff to / from, % | SD/4 mean / median / p99 / max | angle | folds | new cuts (own) | landmark, % |',
    '|---|---|---:|---:|---|---:|---:|---:|---:|---:|---:|',
  ];
  for (const one of cases) {
    if (one.failed) lines.push(`| ${one.name} | remesh | failed: ${one.failed.replaceAll('|', '/')} ||||||||| `);
    else lines.push(...rows(one.name, 'remesh', one));
    lines.push(...rows('', 'projection', one.projected));
  }
  return lines;
}

function timeTable(cases, times) {
  const lines = ['| | new triangles, s | whole command, s | peak memory, MB |', '|---|---:|---:|---:|'];
  for (const one of [...cases.map((each) => ({ ...each, title: each.name })), ...times]) {
    const cells = one.failed ? [one.failed, '', ''] : [one.seconds.toFixed(1), one.wall.toFixed(1), one.peak_mb.toFixed(0)];
    lines.push(`| ${[one.title, ...cells].join(' | ')} |`);
  }
  return lines;
}

function sheets(cases) {
  return cases.filter((one) => !one.failed).flatMap((one) => {
    const names = new Set(one.sources.map((source) => (source.source === 'copy' ? 'wingnut' : source.source)));
    return ['', `### ${one.name}`, '', `![Sheet of ${one.name}](connectivity/${one.name}.png)`, '',
      `![Morph of ${one.name}](connectivity/${one.name}.morph.png)`, '', one.remark, '',
      `<sub>${[...names].map((name) => credits[name]).join('; ')}.</sub>`];
  });
}

mkdirSync(join(docs, 'connectivity'), { recursive: true });
const cases = measureQuality();
const times = measureTime();
writeFileSync(join(docs, 'connectivity-measured.json'), `${JSON.stringify({ connectivity, cases, times }, null, 1)}\n`);
writeFileSync(join(docs, 'connectivity-measured.md'), `${[
  '# How good a new connectivity is, and what it costs', '',
  `Measured by \`${command}\` on ${cpus().length} cores of ${cpus()[0].model}, ${new Date().toISOString().slice(0, 10)}: \`morphbake remesh\` with`,
  `\`max_error\` ${connectivity.max_error} and \`max_vertices\` ${connectivity.max_vertices}, sources aligned by \`"align": "similarity"\`. What the measures mean stands in [connectivity](connectivity.md).`,
  '`projection` is the plainest alternative: the first source\'s triangles, brought onto the other one by the similarity',
  'that fits the landmarks, each vertex then moved to the closest point. Its seconds are for that alone.', '',
  '## Quality', '', ...qualityTable(cases), '',
  'Hausdorff distances are those from a source to its new triangles and back, in per cent of its diagonal; SD/4 is the',
  'symmetric Dirichlet energy of the map from the first source (1: an isometry); angles are in degrees; new cuts are pairs of',
  'triangles that cut one another, in brackets those of the source itself.', '',
  '## Time and memory', '', ...timeTable(cases, times), '',
  'The whole command also measures; that of the pairs and of `four` draws the sheet, too.', '',
  '## Sheets', '', 'A row a source: itself, its new triangles, a checker that equal places share, distortion. Below them the morph',
  'to the last source and back, seen from all sides.',
  ...sheets(cases),
].join('\n')}\n`);
