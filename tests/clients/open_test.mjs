// three.js and Babylon.js open every file without a complaint, and show what the file says: meshes, vertices, targets,
// clips, and where the vertices are when the last clip ends.
// Usage: node open_test.mjs FILE_OR_FOLDER...
import { readFileSync } from 'node:fs';
import path from 'node:path';
import { openPage } from './browser.mjs';
import { evaluateGltf } from './evaluate_gltf.mjs';
import { readAccessor } from './reference/glb.mjs';
import { openPlain } from './reference/plain.mjs';
import { evaluateScene } from './reference/scene.mjs';
import { at, diagonal, distance } from './reference/vectors.mjs';
import { findGlbs, readArguments, startChecks } from './support.mjs';

const TOLERANCE = 1e-5;  // fraction of the diagonal
// Legal things that a client leaves out, and says so, and what the driver says of reading pixels.
const TOLD = /^THREE.GLTFLoader: Ignoring primitive type .extras|GL Driver Message/;
// Babylon.js has no pointers to the weights of meshes, which two forms have for that.
const POINTED = /KHR_animation_pointer\/pointer: Invalid pointer \(\/meshes\/0\/weights\) skipped$/;
const isTold = (file, complaint) => TOLD.test(complaint) || (/-pointer\.glb$/.test(file) && POINTED.test(complaint));
const { files: names } = readArguments();
const checks = startChecks();

/** What every client must find: a list of {node, mesh, primitive, vertices, targets, positions}, and the last clip's end. */
function expectFile(plain) {
  const { json } = plain;
  const animation = (json.animations?.length ?? 0) - 1;
  const inputs = animation < 0 ? [] : json.animations[animation].samplers.map(({ input }) => readAccessor(plain, input).at(-1));
  const end = Math.max(0, ...inputs);
  const shown = nodesShown(json);
  const places = evaluateScene(plain, animation < 0 ? {} : { animation, time: end }).filter(({ node }) => shown.has(node))
    .flatMap(({ node, mesh, primitives }) => primitives.map(({ positions, corners }, primitive) => ({
      node, mesh, primitive, positions, corners, vertices: positions.length / 3,
      isSkinned: json.nodes[node].skin !== undefined,
      targets: json.meshes[mesh].primitives[primitive].targets?.length ?? 0 })));
  return { end, places, clips: animation + 1 };
}

/** The nodes of the scene that a viewer opens first. */
function nodesShown({ scenes, scene = 0, nodes }) {
  const shown = new Set();
  const visit = (node) => shown.add(node) && (nodes[node].children ?? []).forEach(visit);
  scenes?.[scene]?.nodes?.forEach(visit);
  return shown;
}

const nameOf = ({ node, mesh, primitive }) => `node ${node}, mesh ${mesh}, primitive ${primitive}`;

function compare(file, expected, found) {
  const check = (holds, message) => checks.check(holds, `${file}: ${message}`);
  for (const complaint of found.complaints) if (!isTold(file, complaint)) check(false, `complains: ${complaint}`);
  check(found.clips === expected.clips, `${found.clips} clips, expected ${expected.clips}`);
  check(found.places.length === expected.places.length, `${found.places.length} primitives shown, expected ${expected.places.length}`);
  let far = 0;
  for (const place of expected.places) {
    // Babylon hangs a skinned mesh elsewhere than at its node.
    const nameFound = (each) => nameOf(place.isSkinned ? { ...each, node: place.node } : each);
    const same = found.places.find((each) => nameFound(each) === nameOf(place));
    if (!check(same, `${nameOf(place)} is not shown`)) continue;
    check(same.vertices === place.vertices, `${nameOf(place)}: ${same.vertices} vertices, expected ${place.vertices}`);
    check(same.targets === place.targets, `${nameOf(place)}: ${same.targets} targets, expected ${place.targets}`);
    if (same.vertices !== place.vertices) continue;
    const distances = place.corners.map((i) => distance(at(same.positions, i), at(place.positions, i)));
    const off = distances.reduce((a, b) => Math.max(a, b), 0) / diagonal(place.positions);
    check(off <= TOLERANCE, `${nameOf(place)} ends ${off} of its diagonal off`);
    far = Math.max(far, off);
  }
  return far;
}

async function openInThree(browser, bytes, { end }) {
  const played = await evaluateGltf(browser, bytes, [end], -1);
  const positions = played.positionsAt(0);
  return { complaints: played.complaints, clips: played.clips.length,
    places: played.places.map((place, i) => ({ ...place, positions: positions[i] })) };
}

async function openInBabylon(browser, bytes, { end }) {
  await browser.page.waitForFunction('window.ready');
  browser.complaints.length = 0;
  const { places, clips } = await browser.page.evaluate(([url, time]) => window.evaluate(url, time), [browser.send(bytes), end]);
  const values = new Float64Array(new Uint8Array(browser.received.positions).buffer);
  let offset = 0;
  return { complaints: [...browser.complaints], clips,
    places: places.map((place) => ({ ...place, positions: values.subarray(offset, (offset += 3 * place.vertices)) })) };
}

const CLIENTS = { three: { page: 'evaluate.html', open: openInThree }, babylon: { page: 'babylon.html', open: openInBabylon } };

const files = findGlbs(names);
checks.check(files.length > 0, 'there is no file to open');
for (const [client, { page, open }] of Object.entries(CLIENTS)) {
  const browser = await openPage(page);
  for (const file of files) {
    const expected = expectFile(await openPlain(file));
    try {
      const far = compare(`${client}: ${file}`, expected, await open(browser, readFileSync(file), expected));
      console.log(`${client}: ${path.basename(file)}: ${expected.places.length} primitives, ` +
        `off by ${far.toExponential(1)} of the diagonal at the end`);
    } catch (error) {
      checks.check(false, `${client}: ${file}: ${error.message}`);
    }
  }
  await browser.close();
}
checks.finish(`${files.length} files open in three.js and Babylon.js`);
