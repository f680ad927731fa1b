// The tests find what they are for: each fault of the stand-in fails the test that should see it.
// Usage: node faults_test.mjs
import { fileURLToPath } from 'node:url';
import { spawnSync } from 'node:child_process';
import path from 'node:path';
import { startChecks, withFolder } from './support.mjs';

const here = path.dirname(fileURLToPath(import.meta.url));
const STAND_IN = path.join(here, 'stand_in.mjs');
const RECIPE = path.join(here, 'faults', 'pebble.json');
const checks = startChecks();

function run(script, args, fault) {
  const { status, stdout, stderr } = spawnSync(process.execPath, [path.join(here, script), ...args],
    { encoding: 'utf8', env: { ...process.env, STAND_IN_FAULT: fault } });
  if (status === 77) process.stdout.write(stdout), process.exit(77);
  return { status, text: stdout + stderr };
}

function expect(script, args, fault, words) {
  const { status, text } = run(script, args, fault);
  const good = fault ? status === 1 && text.includes(words) : status === 0;
  console.log(`${script} with ${fault || 'no fault'}: ${status}`);
  checks.check(good, `${script} with ${fault || 'no fault'} ended with ${status}:\n${text}`);
}

/** Bakes with a fault, then runs a test of files. */
async function expectOfFiles(script, fault, words) {
  await withFolder((folder) => {
    run('bake_recipes.mjs', ['--morphbake', STAND_IN, '--output', folder, RECIPE], fault);
    expect(script, [folder], fault, words);
  });
}

const throughThree = ['--morphbake', STAND_IN, RECIPE];
expect('three_test.mjs', throughThree, '');
expect('three_test.mjs', throughThree, 'position', 'positions are off');
expect('three_test.mjs', throughThree, 'order', 'positions are off');
expect('three_test.mjs', throughThree, 'normal', 'normals are off');
await expectOfFiles('structure_test.mjs', '');
await expectOfFiles('structure_test.mjs', 'bounds', 'bounds');
await expectOfFiles('structure_test.mjs', 'name', 'target name');
await expectOfFiles('structure_test.mjs', 'weight', 'weights outside 0..1');
await expectOfFiles('validator_test.mjs', '');
await expectOfFiles('validator_test.mjs', 'bounds', 'ACCESSOR_MIN_MISMATCH');
const twice = ['--morphbake', STAND_IN, RECIPE];
expect('determinism_test.mjs', twice, '');
expect('determinism_test.mjs', twice, 'threads', '2 threads: nose.gif differs');
expect('determinism_test.mjs', twice, 'locale', 'de_DE.UTF-8: nose.sheet.png differs');
checks.finish('every fault is found');
