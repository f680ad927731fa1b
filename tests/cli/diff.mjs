// Whether two files show the same: other bases of one motion pass, one moved vertex does not, and it is told where.
//
//   node diff.mjs MORPHBAKE SCRATCH SHAPES
import { copyFileSync, mkdirSync, readFileSync, symlinkSync, writeFileSync } from 'node:fs';
import path from 'node:path';
import { fileURLToPath } from 'node:url';
import { floatsOf, readGlb, writeGlb } from './glb.mjs';
import { octahedron } from './bad_gltf/good.mjs';
import { filesBelow, startTesting } from './testing.mjs';

const here = path.dirname(fileURLToPath(import.meta.url));
const [program, scratch, shapes] = process.argv.slice(2).map((each) => path.resolve(each));
const { check, run, finish } = startTesting(program, scratch);
const diff = (code, ...words) => run(code, ['diff', ...words]);
const json = (code, ...words) => JSON.parse(diff(code, ...words, '--json').stdout);
const kindsOf = (found, isDifference) => [...new Set([...found.findings, ...found.meshes.flatMap(({ findings }) => findings)]
  .filter(({ difference }) => difference === isDifference).map(({ kind }) => kind))].sort().join();

/** Bakes a bar that bends in 120 frames. */
function bar(name, targets, more = {}) {
  writeFileSync(`${name}.json`, JSON.stringify({ version: 1, name: 'bar', representation: 'laplacian',
    sources: { straight: `${shapes}/bar_straight.glb`, bent: `${shapes}/bar_bent_twisted.glb` },
    timeline: { fps: 60, tracks: [{ name: 'bend', to: 'bent', begin: 0, end: 119 / 60, ease: 'smoothstep', ...more }], duration: 119 / 60 },
    outputs: [{ file: `${name}.glb`, targets }] }));
  run(0, ['bake', `${name}.json`, '--preview', 'none']);
}

bar('tracks', 'tracks');
bar('frames', 'frames');
bar('late', 'frames', { begin: 0.01 });

// Two bases of one motion.
for (const pair of [['tracks.glb', 'frames.glb'], ['frames.glb', 'tracks.glb']]) {
  const same = json(0, ...pair);
  check(same.same && kindsOf(same, true) === '', `${pair}: ${JSON.stringify(same)}`);
  check(kindsOf(same, false).includes('targets'), `${pair}: another basis is not told`);
  const clip = same.meshes[0].clips[1];
  check(clip.instants > 2 * 120, `${pair}: only ${clip.instants} times`);
  check(!same.meshes[0].allowed.normal_angle, `${pair}: normals of other targets are judged`);
}
check(diff(0, 'tracks.glb', 'frames.glb').stdout.trimEnd().endsWith('\nsame'), 'the table does not end with "same"');
check(kindsOf(json(1, 'tracks.glb', 'frames.glb', '--strict'), true).includes('targets'), '--strict lets other targets pass');
check(json(0, 'frames.glb', 'frames.glb', '--strict').same, 'a file differs from itself');
const late = json(1, 'frames.glb', 'late.glb');
check(kindsOf(late, true).includes('positions'), 'a motion that begins later passes');

// One vertex, moved by 2e-5 of the diagonal in one frame of 120: measured here, without the program.
const frames = readGlb('frames.glb');
const primitive = frames.json.meshes[0].primitives[0];
const base = floatsOf(frames, primitive.attributes.POSITION);
const side = (axis) => {
  const numbers = Array.from({ length: base.length / 3 }, (_, v) => base.get(3 * v + axis));
  return Math.max(...numbers) - Math.min(...numbers);
};
const diagonal = Math.hypot(side(0), side(1), side(2));
const VERTEX = 17, FRAME = 70;
check(primitive.targets.length === 119, `${primitive.targets.length} targets`);
const moved = floatsOf(frames, primitive.targets[FRAME - 1].POSITION);
moved.set(3 * VERTEX + 1, moved.get(3 * VERTEX + 1) + 2e-5 * diagonal);
writeGlb('moved.glb', frames);
for (const first of ['frames.glb', 'tracks.glb']) {
  const found = json(1, first, 'moved.glb');
  const { value, time, vertex, primitive: at } = found.meshes[0].clips[1].position;
  check(kindsOf(found, true) === 'positions', `${first}: differs by ${kindsOf(found, true)}`);
  check(vertex === VERTEX && at === 0 && Math.abs(time - FRAME / 60) < 1e-6, `${first}: vertex ${vertex} at ${time} s`);
  check(Math.abs(value / diagonal - 2e-5) < 2e-6, `${first}: ${value / diagonal} of the diagonal`);
  check(Math.abs(found.meshes[0].diagonal / diagonal - 1) < 1e-6, `${first}: diagonal ${found.meshes[0].diagonal}, not ${diagonal}`);
  check(found.meshes[0].vertices_beyond === 1, `${first}: ${found.meshes[0].vertices_beyond} vertices beyond`);
}
json(0, 'frames.glb', 'moved.glb', '--relative', '3e-5');
json(0, 'frames.glb', 'moved.glb', '--tolerance', String(3e-5 * diagonal));
json(1, 'frames.glb', 'moved.glb', '--tolerance', String(1e-5 * diagonal));

// The table: worst vertex, time, clip, how much.
const table = diff(1, 'frames.glb', 'moved.glb').stdout;
for (const text of ['bar', '(2.00e-05 of the diagonal)', 'vertex 17 of primitive 0', 'at 1.167 s', '[positions]', '\ndifferent\n'])
  check(table.includes(text), `the table lacks ${text}:\n${table}`);

// Evidence, read back.
const shown = diff(1, 'frames.glb', 'moved.glb', '--heatmap', 'out/heat.glb', '--turntable', 'out/turn', '--formats', 'sheet',
  '--size', '64x48', '--frames', '3', '--set', '/turntable/samples=1');
check(filesBelow('out').join() === 'heat.glb,turn.sheet.png', `wrote ${filesBelow('out')}`);
check(shown.stdout.startsWith('out/heat.glb\nout/turn.sheet.png\n'), 'the files are not told');
const heat = readGlb('out/heat.glb');
const attributes = heat.json.meshes[0].primitives[0].attributes;
const colours = floatsOf(heat, attributes.COLOR_0), places = floatsOf(heat, attributes.POSITION);
check(colours.length === base.length && places.length === base.length, 'the heat-map has other vertices');
for (let v = 0; v < colours.length / 3; ++v) {
  const [red, green, blue] = [0, 1, 2].map((c) => colours.get(3 * v + c));
  const isYellow = red > 0.9 && green > 0.5 && blue < 0.1;
  check(isYellow === (v === VERTEX), `vertex ${v} of the heat-map is ${[red, green, blue]}`);
  check([0, 1, 2].every((c) => Math.abs(places.get(3 * v + c) - base.get(3 * v + c)) < 1e-6 * diagonal), `vertex ${v} of the heat-map lies elsewhere`);
}

// Not a byte depends on threads, locale or chance.
const plain = diff(1, 'tracks.glb', 'moved.glb', '--json', '--heatmap', 'heat1.glb').stdout;
const other = run(1, ['diff', 'tracks.glb', 'moved.glb', '--json', '--heatmap', 'heat2.glb', '--threads', '1'], { LC_ALL: 'de_DE.UTF-8' }).stdout;
check(plain === other, 'threads or locale change the JSON');
check(readFileSync('heat1.glb').equals(readFileSync('heat2.glb')), 'threads or locale change the heat-map');

// Structure and everything else that has a meaning.
function changed(name, change) {
  const file = readGlb('frames.glb');
  change(file.json, file);
  writeGlb(`${name}.glb`, file);
  return `${name}.glb`;
}
const expected = {
  bounds: [changed('bounds', (gltf) => { gltf.accessors[gltf.meshes[0].primitives[0].attributes.POSITION].max[1] += 0.1; }), 'bounds'],
  name: [changed('clip', (gltf) => { gltf.animations.at(-1).name = 'other'; }), 'animations'],
  gone: [changed('gone', (gltf) => { delete gltf.animations; }), 'animations'],
  scaled: [changed('scaled', (gltf) => { gltf.nodes[0].scale = [1, 1, 1.001]; }), 'positions'],
  material: [changed('material', (gltf) => { gltf.materials = [{ name: 'new', pbrMetallicRoughness: { baseColorFactor: [1, 0, 0, 1] } }]; gltf.meshes[0].primitives[0].material = 0; }), 'material,material-values'],
  attribute: [changed('attribute', (gltf) => { gltf.meshes[0].primitives[0].attributes._EXTRA = gltf.meshes[0].primitives[0].attributes.POSITION; }), 'attributes'],
  corner: [changed('corner', (gltf, file) => {
    const view = gltf.bufferViews[gltf.accessors[gltf.meshes[0].primitives[0].indices].bufferView];
    const width = gltf.accessors[gltf.meshes[0].primitives[0].indices].componentType === 5125 ? 4 : 2;
    file.binary.copy(file.binary, (view.byteOffset ?? 0) + 2 * width, (view.byteOffset ?? 0) + 3 * width, (view.byteOffset ?? 0) + 4 * width);
  }), 'triangles'],
};
for (const [name, [file, kinds]] of Object.entries(expected)) {
  const found = kindsOf(json(1, 'frames.glb', file), true);
  check(found === kinds, `${name}: told as ${found}, not ${kinds}`);
}

// Files of several meshes, also of lines, are read; --node chooses one.
const several = octahedron();
several.nodes = [{ name: 'left', mesh: 0 }, { name: 'right', mesh: 0, translation: [3, 0, 0] }, { name: 'wire', mesh: 1 }];
several.scenes = [{ nodes: [0, 1, 2] }];
several.meshes.push({ primitives: [{ attributes: { POSITION: 0 }, indices: 2, mode: 1 }] });
writeFileSync('several.gltf', JSON.stringify(several));
several.nodes[1].translation = [3, 0, 0.1];
writeFileSync('shifted.gltf', JSON.stringify(several));
const both = json(0, 'several.gltf', 'several.gltf');
check(both.meshes.map(({ name }) => name).join() === 'left,right', `compares ${both.meshes.map(({ name }) => name)}`);
check(kindsOf(both, false) === 'not-triangles', `lines are told as ${kindsOf(both, false)}`);
check(json(1, 'several.gltf', 'shifted.gltf').meshes[1].vertices_beyond === 6, 'a shifted second mesh passes');
json(0, 'several.gltf', 'shifted.gltf', '--node', 'left');
json(1, 'several.gltf', 'shifted.gltf', '--node', 'right');
several.scenes[0].nodes = [0];
writeFileSync('fewer.gltf', JSON.stringify(several));
check(kindsOf(json(1, 'several.gltf', 'fewer.gltf'), true).includes('meshes'), 'a mesh that is gone passes');

// Files of packers are read. Sparse accessors change nothing; quantised ones are off by half a step; a packer that puts
// the vertices in another order makes another mesh.
const packed = (name) => path.join(here, 'diff_files', name);
check(kindsOf(json(0, packed('morph.glb'), packed('gltf-transform.glb'), '--strict'), true) === '', 'sparse accessors make a difference');
check(kindsOf(json(1, packed('morph.glb'), packed('gltf-transform-quantized.glb')), true) === 'positions', 'quantisation');
json(0, packed('morph.glb'), packed('gltf-transform-quantized.glb'), '--relative', '1e-4');
check(kindsOf(json(1, packed('morph.glb'), packed('gltfpack.glb')), true) === 'positions,triangles', 'gltfpack');
json(0, packed('gltfpack.glb'), packed('gltfpack.glb'), '--strict');

// What is wrong is told, with exit code 2 whatever it is, and leaves nothing.
const refuse = (texts, ...words) => {
  const { stdout, stderr } = diff(2, ...words);
  check(stdout === '', `prints a verdict: ${words.join(' ')}`);
  for (const text of texts) check(stderr.includes(text), `${words.join(' ')}: stderr lacks ${text}:\n${stderr}`);
};
writeFileSync('cut.glb', readFileSync('frames.glb').subarray(0, 3000));
refuse(['none.glb: error', '[files.missing]', 'cut.glb: error', '[gltf.truncated]'], 'none.glb', 'cut.glb', '--heatmap', 'wrong/a.glb');
refuse(['[gltf.no-such-node]'], 'frames.glb', 'tracks.glb', '--node', 'nobody');
refuse(['--tolerance', "'-1' is no number"], 'frames.glb', 'tracks.glb', '--tolerance', '-1');
refuse(['--relative', "'nan' is no number"], 'frames.glb', 'tracks.glb', '--relative', 'nan');
refuse(['--normals', "'181' is no number from 0 to 180"], 'frames.glb', 'tracks.glb', '--normals', '181');
refuse(['--size', 'WIDTHxHEIGHT'], 'frames.glb', 'tracks.glb', '--size', 'large', '-o', 'wrong/a');
refuse(['SECOND'], 'frames.glb');
copyFileSync('frames.glb', 'kept.glb');
symlinkSync('kept.glb', 'link.glb');
refuse(['is a file that is compared'], 'kept.glb', 'tracks.glb', '--heatmap', 'link.glb');
check(readFileSync('kept.glb').equals(readFileSync('frames.glb')), 'the heat-map has replaced what is compared');
mkdirSync('folder.glb');
refuse(['[output.unwritable]'], 'frames.glb', 'tracks.glb', '--heatmap', 'folder.glb');
check(filesBelow('wrong').length === 0, `left behind: ${filesBelow('wrong')}`);
finish();
