// Every glTF 2.0 file of Debian's assimp-testmodels is baked and kept, or refused for the reason that stands here.
// Usage: node models_test.mjs --morphbake PROGRAM --output FOLDER [PART-OF-A-NAME...]    the files are left in FOLDER/baked,
// those of sources that are not legal in FOLDER/faulty: what was wrong with them still is, so no client need open them
import { spawnSync } from 'node:child_process';
import { mkdirSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import path from 'node:path';
import { putIndices, putMesh, putPoints, startDocument, toGlb, UNSIGNED_INT } from './forms/document.mjs';
import { countIssues, errorsIn, newIssues } from './issues.mjs';
import { findLost } from './kept.mjs';
import { openPlain } from './reference/plain.mjs';
import { evaluateScene } from './reference/scene.mjs';
import { at, diagonal, distance } from './reference/vectors.mjs';
import { bake, readArguments, skip, startChecks } from './support.mjs';

const FOLDER = '/glTF2/';
const TOLERANCE = 1e-5;  // fraction of the diagonal
const TRIANGLES = [4, 5, 6];

/** What is not baked, and what must be told of it: the code, and what is missing or wrong. */
const REFUSED = {
  ...Object.fromEntries(['00', '01', '02', '03', '07', '08', '09', '10'].map((number) =>
    [`glTF-Asset-Generator/Mesh_PrimitiveMode/Mesh_PrimitiveMode_${number}.gltf`, ['gltf.unsupported-primitive']])),
  'BoxTextured-glTF-techniqueWebGL/BoxTextured.gltf': ['gltf.unsupported-extension', '#/extensionsRequired/0', 'KHR_technique_webgl'],
  'BoxWithInfinites-glTF-Binary/BoxWithInfinites.glb': ['gltf.not-finite', '#/meshes/0/primitives/0/attributes/POSITION'],
  'IncorrectVertexArrays/Cube.gltf': ['gltf.invalid', '#/bufferViews/2', '936', '514'],
  'IndexOutOfRange/AllIndicesOutOfRange.gltf': ['gltf.accessor', '#/meshes/0/primitives/0/indices', '65535'],
  'IndexOutOfRange/IndexOutOfRange.gltf': ['gltf.accessor', '#/meshes/0/primitives/0/indices', '255'],
  'MissingBin/BoxTextured.gltf': ['gltf.missing-file', '#/buffers/0/uri', 'BoxTextured0.bin'],
  'RecursiveNodes/RecursiveNodes.gltf': ['gltf.invalid', '#/nodes/'],
  'SchemaFailures/sceneWrongType.gltf': ['gltf.wrong-type', '#/scene', '"hello"'],
  'TestNoRootNode/NoScene.gltf': ['gltf.invalid'],
  'TestNoRootNode/SceneWithoutNodes.gltf': ['gltf.no-mesh'],
  'wrongTypes/badUint.gltf': ['gltf.invalid', '#/materials/0/pbrMetallicRoughness/baseColorTexture/index'],
  'wrongTypes/badArray.gltf': ['gltf.wrong-type', '#/meshes/0/primitives'],
};

const { morphbake, output, files: only } = readArguments('morphbake', 'output');
const checks = startChecks();

function listModels() {
  const { stdout } = spawnSync('dpkg', ['-L', 'assimp-testmodels'], { encoding: 'utf8' });
  const files = (stdout ?? '').split('\n').filter((file) => file.includes(FOLDER) && /\.(gltf|glb)$/.test(file));
  if (files.length === 0) skip('assimp-testmodels is not installed (apt-get install assimp-testmodels)');
  return files.sort();
}

const nameOf = (file) => file.slice(file.indexOf(FOLDER) + FOLDER.length);

/** The first node of the scene that shows triangles only, and whether others have meshes too. Files may be broken. */
function chooseNode({ scenes, scene = 0, nodes, meshes }) {
  const shown = new Set();
  const visit = (node) => {
    if (!shown.has(node)) shown.add(node), (nodes[node].children ?? []).forEach(visit);
  };
  (scenes?.[scene]?.nodes ?? []).forEach(visit);
  const withMesh = [...shown].filter((node) => nodes[node].mesh !== undefined);
  const isSurface = (node) => [meshes[nodes[node].mesh].primitives].flat().every(({ mode = 4 }) => TRIANGLES.includes(mode));
  return { node: withMesh.find(isSurface) ?? withMesh[0], isAlone: withMesh.length < 2 };
}

/** The node's shape as the scene shows it, waved: same corners, every corner a vertex. */
function writeSculpt(plain, node, file) {
  const document = startDocument([{ mesh: 0 }]);
  const [{ primitives }] = evaluateScene(plain).filter((each) => each.node === node);
  const size = diagonal(primitives.flatMap(({ positions }) => [...positions]));
  const wave = (p) => p.map((x, k) => x + 0.05 * size * Math.sin(3 * p[(k + 1) % 3] / size + k));
  putMesh(document, primitives.map(({ positions, corners }) => ({
    attributes: { POSITION: putPoints(document, corners.map((i) => wave(at(positions, i)))) },
    indices: putIndices(document, corners.map((_, corner) => corner), UNSIGNED_INT) })));
  writeFileSync(file, toGlb(document));
}

function writeRecipe(folder, file, sculpt, outputFile, { node, isAlone }) {
  const source = { file: path.relative(folder, file), ...(!isAlone && { node }) };
  const recipe = { version: 1, name: 'model', sources: { model: source, sculpt: path.basename(sculpt) },
    timeline: { keys: [{ time: 0, state: 'model' }, { time: 1, state: 'sculpt' }] },
    outputs: [{ file: outputFile, targets: 'tracks' }] };
  const name = path.join(folder, 'recipe.json');
  writeFileSync(name, JSON.stringify(recipe));
  return name;
}

/** Why `inspect` refuses the file, or null. */
function inspect(file, { node, isAlone }) {
  const words = ['inspect', file, ...(isAlone ? [] : ['--node', String(node)])];
  const { status, stderr } = spawnSync(morphbake, words, { encoding: 'utf8' });
  return status === 0 ? null : stderr.trim();
}

/** Both ends of the new clip, as the scene shows them. */
function compareEnds(name, source, sculpt, baked, node) {
  const shape = (plain, moment, index) => evaluateScene(plain, moment)
    .find((each) => each.node === index).primitives.map(({ positions, corners }) => corners.map((i) => at(positions, i)));
  const animation = baked.json.animations.length - 1;
  const scale = diagonal(shape(source, {}, node).flat(2));
  for (const [time, expected] of [[0, shape(source, {}, node)], [1, shape(sculpt, {}, 0)]])
    shape(baked, { animation, time }, node).forEach((found, p) => {
      const off = Math.max(...found.map((point, i) => distance(point, expected[p][i]))) / scale;
      checks.check(off <= TOLERANCE, `${name}: at ${time} s primitive ${p} is ${off} of the diagonal off`);
    });
}

/** Bakes the model into a sculpt of it. @return the files, or why it is refused */
async function bakeModel(file, name, choice) {
  const refusal = inspect(file, choice);
  if (refusal) return { refusal };
  const folder = path.join(output, 'sources', name);
  const baked = `${name.slice(0, name.lastIndexOf('.')).replaceAll('/', '--')}.glb`;
  mkdirSync(folder, { recursive: true });
  const sculpt = path.join(folder, 'sculpt.glb');
  writeSculpt(await openPlain(file), choice.node, sculpt);
  const baking = path.join(output, errorsIn(await countIssues(file)).length ? 'faulty' : 'baked');
  try {
    bake(morphbake, writeRecipe(folder, file, sculpt, baked, choice), baking);
  } catch (error) {
    return { refusal: error.message };
  }
  return { sculpt, baked: path.join(baking, baked) };
}

async function compareModel(file, name, choice, { sculpt, baked }) {
  for (const issue of newIssues(await countIssues(file), await countIssues(baked))) checks.check(false, `${name}: ${issue}`);
  for (const lost of await findLost(file, baked, choice)) checks.check(false, `${name}: ${lost}`);
  const [source, ...ends] = await Promise.all([file, sculpt, baked].map(openPlain));
  compareEnds(name, source, ...ends, choice.node);
}

async function testModel(file) {
  const name = nameOf(file);
  const choice = chooseNode(parse(file));
  const expected = REFUSED[name];
  const { refusal, ...made } = await bakeModel(file, name, choice);
  console.log(`${name}: ${refusal ? 'refused' : 'baked'}`);
  if (expected) checks.check(expected.every((text) => refusal?.includes(text)), `${name} must be refused for ${expected}: ${refusal}`);
  else if (refusal) checks.check(false, `${name} is refused: ${refusal}`);
  else await compareModel(file, name, choice, made);
}

/** The JSON of a file, or nothing where it has none. */
function parse(file) {
  const bytes = readFileSync(file);
  const isGlb = bytes.toString('latin1', 0, 4) === 'glTF';
  const text = isGlb ? bytes.toString('utf8', 20, 20 + bytes.readUInt32LE(12)) : bytes.toString('utf8');
  try {
    return JSON.parse(text);
  } catch {
    return {};
  }
}

const files = listModels().filter((file) => only.length === 0 || only.some((part) => file.includes(part)));
if (only.length === 0) rmSync(output, { recursive: true, force: true });
for (const file of files)
  try {
    await testModel(file);
  } catch (error) {
    checks.check(false, `${nameOf(file)}: ${error.stack}`);
  }
checks.finish(`${files.length} models, of which ${Object.keys(REFUSED).length} are refused for good reason`);
