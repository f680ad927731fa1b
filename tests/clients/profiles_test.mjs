// One motion for every verified profile: its own client shows it within max_error at all frames, the validator finds
// nothing wrong, and `lint` neither. The motion itself is a target a frame, read by code that shares nothing with ours.
// Usage: node profiles_test.mjs --morphbake PROGRAM --output FOLDER
import { spawnSync } from 'node:child_process';
import { mkdirSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import path from 'node:path';
import { openPage } from './browser.mjs';
import { evaluateGltf } from './evaluate_gltf.mjs';
import { readAccessor } from './reference/glb.mjs';
import { openPlain } from './reference/plain.mjs';
import { evaluateScene } from './reference/scene.mjs';
import { at, diagonal, distance } from './reference/vectors.mjs';
import { bake, placeRecipe, readArguments, requireModule, startChecks, withFolder } from './support.mjs';

const { morphbake, output } = readArguments('morphbake', 'output');
const checks = startChecks();
const BOUND = 1e-3, COARSE = 2e-2; // of the diagonal; spec-min has four targets
const PROFILES = { 'web-three': BOUND, 'babylon': BOUND, 'blender': BOUND, 'archive': BOUND, 'spec-min': COARSE };
const ROUNDING = 1e-6;

const recipe = { version: 1, name: 'profiles', units: 'scene', hold: 'none', sources: { orb: 'orb.glb', long: 'orb-long.glb' },
  regions: { below: { spatial: { half_space: { normal: [0, 0, 1], offset: { keys: [{ time: 0, value: -1.3 }, { time: 1, value: 1.3 }] } }, width: 0.5 } } },
  timeline: { fps: 24, tracks: [{ name: 'all', region: 'below', to: 'long', begin: 0, end: 1, ease: 'linear' }] },
  outputs: [{ file: 'frames.glb', targets: 'frames', encoding: 'float' },
    ...Object.entries(PROFILES).map(([profile, max_error]) => ({ file: `${profile}.glb`, profile, max_error }))] };

async function inThree(browser, bytes, times) {
  const played = await evaluateGltf(browser, bytes, times, -1);
  for (const complaint of played.complaints) checks.check(/GL Driver Message/.test(complaint), `three.js: ${complaint}`);
  return times.map((_, k) => played.positionsAt(k)[0]);
}

async function inBabylon(browser, bytes, times) {
  await browser.page.waitForFunction('window.ready');
  const url = browser.send(bytes), all = [];
  for (const time of times) {
    await browser.page.evaluate(([file, moment]) => window.evaluate(file, moment), [url, time]);
    all.push(new Float64Array(new Uint8Array(browser.received.positions).buffer));
  }
  return all;
}

const inReference = async (file, times) => {
  const plain = await openPlain(file);
  return times.map((time) => evaluateScene(plain, { animation: 0, time })[0].primitives[0].positions);
};

/** The largest distance of two motions, as a fraction of the first frame's diagonal. */
function farthest(exact, shown) {
  const size = diagonal(exact[0]);
  return Math.max(...exact.map((rows, f) => {
    let far = 0;
    for (let i = 0; i < rows.length / 3; i++) far = Math.max(far, distance(at(rows, i), at(shown[f], i)));
    return far / size;
  }));
}

rmSync(output, { recursive: true, force: true });
mkdirSync(output, { recursive: true });
await withFolder(async (folder) => {
  const file = path.join(folder, 'recipe.json');
  writeFileSync(file, JSON.stringify(recipe));
  bake(morphbake, placeRecipe(file, path.join(folder, 'placed')), output);
});
const frames = await openPlain(path.join(output, 'frames.glb'));
const times = [...readAccessor(frames, frames.json.animations[0].samplers[0].input)];
const exact = await inReference(path.join(output, 'frames.glb'), times);
const clients = { 'web-three': { page: 'evaluate.html', show: inThree }, babylon: { page: 'babylon.html', show: inBabylon } };
const validator = requireModule('gltf-validator');
for (const [profile, bound] of Object.entries(PROFILES)) {
  const glb = path.join(output, `${profile}.glb`);
  const bytes = readFileSync(glb);
  const { issues } = await validator.validateBytes(new Uint8Array(bytes));
  checks.check(issues.numErrors === 0 && issues.numWarnings === 0, `${profile}: ${JSON.stringify(issues.messages)}`);
  const lint = spawnSync(morphbake, ['lint', glb, '--profile', profile, '--strict'], { encoding: 'utf8' });
  checks.check(lint.status === 0, `${profile}: lint says ${lint.stdout}${lint.stderr}`);
  const shown = { reference: await inReference(glb, times) };
  if (clients[profile]) {
    const browser = await openPage(clients[profile].page);
    shown.client = await clients[profile].show(browser, bytes, times);
    await browser.close();
  }
  for (const [by, motion] of Object.entries(shown)) {
    const far = farthest(exact, motion);
    console.log(`${profile}: ${by === 'client' ? 'its client' : 'the reference'} is ${far.toExponential(2)} off in ${times.length} frames`);
    checks.check(far <= bound + ROUNDING, `${profile}: ${by} is ${far} off, more than ${bound}`);
  }
}
checks.finish('profiles');
