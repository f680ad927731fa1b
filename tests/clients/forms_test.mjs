// Every form in which glTF may hold a surface is read, morphs into another of the same form, and keeps what it had.
// Usage: node forms_test.mjs --morphbake PROGRAM --output FOLDER [FORM...]    the files are left in FOLDER/baked
import { mkdirSync, rmSync, writeFileSync } from 'node:fs';
import path from 'node:path';
import { FORMS, writeForm } from './forms/forms.mjs';
import { countIssues, errorsIn, newIssues } from './issues.mjs';
import { findLost } from './kept.mjs';
import { openPlain } from './reference/plain.mjs';
import { evaluateScene } from './reference/scene.mjs';
import { diagonal } from './reference/vectors.mjs';
import { farthest, shapeOf } from './shape.mjs';
import { bake, readArguments, startChecks } from './support.mjs';

const TOLERANCE = 1e-5;  // fraction of the source's diagonal
const FLOAT_STEP = 1e-6;  // of positions of size 1, where weights of bytes become float32
const { morphbake, output, files: only } = readArguments('morphbake', 'output');
const checks = startChecks();

function writeRecipe(name, { a, b }, folder) {
  const { select, start = 'a', ...form } = FORMS[name];
  const source = (which, file) => ({ file: path.relative(folder, file), ...select, ...form[which] });
  const recipe = { version: 1, name, sources: { a: source('a', a), b: source('b', b) },
    timeline: { keys: [{ time: 0, state: start }, { time: 1, state: start === 'a' ? 'b' : 'a' }] },
    outputs: [{ file: `${name}.glb`, targets: 'tracks' }] };
  const file = path.join(folder, 'recipe.json');
  writeFileSync(file, JSON.stringify(recipe));
  return file;
}

/** The node that a source's `node` or `mesh` means. */
function subjectOf({ json }, { node, mesh } = {}) {
  if (typeof node === 'number') return node;
  const named = json.nodes.findIndex((each) => node !== undefined && each.name === node);
  const shows = (each) => each.mesh !== undefined && (mesh === undefined || json.meshes[each.mesh].name === mesh);
  return named >= 0 ? named : json.nodes.findIndex(shows);
}

/** Shapes of the subject at both ends of the new clip, and of all other nodes. */
function compareShapes(name, { a, b, baked }) {
  const { select, moments = {}, start: first = 'a' } = FORMS[name];
  const shapes = [[a, moments.a], [b, moments.b]].map(([plain, moment]) =>
    shapeOf(evaluateScene(plain, moment), subjectOf(plain, select)));
  const [start, end] = first === 'a' ? shapes : shapes.toReversed();
  const subject = subjectOf(a, select);
  const animation = baked.json.animations.length - 1;
  const scale = diagonal(start);
  const off = [[0, start], [1, end]].map(([time, expected]) => {
    const scene = evaluateScene(baked, { animation, time });
    for (const { node } of scene) {
      const isStill = node === subject || farthest(shapeOf(scene, node), shapeOf(evaluateScene(a), node)) === 0;
      checks.check(isStill, `${name}: node ${node} moves`);
    }
    return farthest(shapeOf(scene, subject), expected) / scale;
  });
  checks.check(off[0] <= TOLERANCE, `${name}: starts ${off[0]} of the diagonal off`);
  checks.check(off[1] <= TOLERANCE, `${name}: ends ${off[1]} of the diagonal off`);
  return off;
}

/** Clips of the source still do what they did. */
function compareClips(name, a, baked, startsThere) {
  if (!startsThere) return;
  (a.json.animations ?? []).forEach((_, animation) => {
    for (const time of [0, 0.3, 0.5, 1.1, 5])
      for (const { node } of evaluateScene(a)) {
        const [was, is] = [a, baked].map((plain) => shapeOf(evaluateScene(plain, { animation, time }), node));
        checks.check(farthest(is, was) < FLOAT_STEP,
          `${name}: at ${time} s animation ${animation} shows node ${node} elsewhere`);
      }
  });
}

/** A target without NORMAL among others with it breaks normals in three.js and Babylon.js. */
function checkTargetSets(name, { json }) {
  for (const primitive of json.meshes.flatMap((mesh) => mesh.primitives)) {
    const sets = new Set((primitive.targets ?? []).map((target) => Object.keys(target).sort().join()));
    checks.check(sets.size <= 1, `${name}: targets with different attributes: ${[...sets].join(' | ')}`);
  }
}

const countOf = (list, value) => list.filter((each) => each === value).length;

/** Clients know targets and clips by their names. */
function checkNames(name, { json }, node) {
  for (const names of [json.meshes[json.nodes[node].mesh].extras?.targetNames ?? [], (json.animations ?? []).map((each) => each.name)])
    checks.check(countOf(names, names.at(-1)) === 1, `${name}: the name ${names.at(-1)} is there twice`);
}

/** Nothing of ours is told by neither a view nor sparse: some clients take that for an error. */
function checkAccessors(name, a, baked) {
  const bare = ({ written }) => written.accessors.filter(({ bufferView, sparse }) => bufferView === undefined && !sparse).length;
  checks.check(bare(baked) <= bare(a), `${name}: ${bare(baked) - bare(a)} new accessors without bytes`);
}

/** How many bytes of the buffers no view shows. */
function unseenBytes({ buffers = [], bufferViews = [] }) {
  const ranges = bufferViews.map(({ buffer, byteOffset = 0, byteLength }) => ({ buffer, begin: byteOffset, end: byteOffset + byteLength }))
    .sort((a, b) => a.buffer - b.buffer || a.begin - b.begin);
  let [seen, last] = [0, { buffer: -1, end: 0 }];
  for (const { buffer, begin, end } of ranges) {
    const from = buffer === last.buffer ? Math.max(begin, last.end) : begin;
    seen += Math.max(0, end - from);
    last = { buffer, end: buffer === last.buffer ? Math.max(end, last.end) : end };
  }
  return buffers.reduce((sum, { byteLength }) => sum + byteLength, 0) - seen;
}

/** Bytes of what was replaced or unpacked do not stay, but for what aligns the rest. */
function checkBytes(name, a, baked) {
  const aligning = 3 * baked.written.bufferViews.length;
  const left = unseenBytes(baked.written) - aligning;
  checks.check(left <= Math.max(0, unseenBytes(a.written)), `${name}: ${left} bytes that nothing shows`);
}

async function testForm(name) {
  const folder = path.join(output, 'sources', name);
  mkdirSync(folder, { recursive: true });
  const files = await writeForm(name, folder);
  const issues = await countIssues(files.a);
  checks.check(errorsIn(issues).length === 0, `${name}: the source itself is not legal: ${errorsIn(issues)}`);
  const baking = path.join(output, 'baked');
  bake(morphbake, writeRecipe(name, files, folder), baking);
  const file = path.join(baking, `${name}.glb`);
  for (const issue of newIssues(issues, await countIssues(file))) checks.check(false, `${name}: ${issue}`);
  const [a, b, baked] = await Promise.all([files.a, files.b, file].map(openPlain));
  const startsThere = FORMS[name].a === undefined && FORMS[name].start === undefined;
  const node = subjectOf(a, FORMS[name].select);
  for (const lost of await findLost(files.a, file, { node, startsThere, dropsSkin: FORMS[name].dropsSkin })) checks.check(false, `${name}: ${lost}`);
  checkTargetSets(name, baked);
  checkNames(name, baked, node);
  checkAccessors(name, a, baked);
  checkBytes(name, a, baked);
  const off = compareShapes(name, { a, b, baked });
  compareClips(name, a, baked, startsThere);
  console.log(`${name}: off by ${off[0].toExponential(1)} at the start, ${off[1].toExponential(1)} at the end`);
}

if (only.length === 0) rmSync(output, { recursive: true, force: true });
const names = only.length ? only : Object.keys(FORMS);
for (const name of names)
  try {
    await testForm(name);
  } catch (error) {
    checks.check(false, `${name}: ${error.message}`);
  }
checks.finish(`${names.length} forms are read, morph and are kept`);
