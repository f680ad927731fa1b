// The same bytes on any number of threads, in any folder, in any locale.
// Usage: node determinism_test.mjs --morphbake PROGRAM RECIPE
import { spawnSync } from 'node:child_process';
import { mkdirSync, readdirSync, readFileSync, statSync } from 'node:fs';
import path from 'node:path';
import { bake, placeRecipe, readArguments, startChecks, withFolder } from './support.mjs';

const { morphbake, files: [recipe] } = readArguments('morphbake');
const checks = startChecks();
const NEEDED = ['.glb', '.png', '.gif'];

/** The variables that set a German locale, generated when the system has none. */
function germanEnvironment(folder) {
  const inGerman = (env) => spawnSync('bash', ['-c', 'printf %.1f 1,5'], { encoding: 'utf8', env: { ...process.env, ...env } }).stdout;
  const installed = { LC_ALL: 'de_DE.UTF-8' };
  if (inGerman(installed) === '1,5') return installed;
  mkdirSync(folder, { recursive: true });
  const made = spawnSync('localedef', ['-i', 'de_DE', '-f', 'UTF-8', path.join(folder, 'de_DE.UTF-8')], { encoding: 'utf8' });
  const generated = { LC_ALL: 'de_DE.UTF-8', LOCPATH: folder };
  // A program that falls back to C would pass the test for nothing.
  if (inGerman(generated) !== '1,5')
    throw new Error(`cannot make the locale de_DE.UTF-8 (apt-get install locales): ${made.stderr ?? made.error}`);
  return generated;
}

/** Every output file below `folder` but the report, which tells seconds: {name: bytes}. */
function readOutputs(folder) {
  const names = readdirSync(folder, { recursive: true }).filter((name) => statSync(path.join(folder, name)).isFile());
  return Object.fromEntries(names.filter((name) => name !== 'report.json').sort()
    .map((name) => [name, readFileSync(path.join(folder, name))]));
}

function bakeIn(folder, threads, env) {
  const placed = placeRecipe(recipe, path.join(folder, 'recipe'));
  bake(morphbake, placed, path.join(folder, 'baked'), { preview: 'as the recipe says', args: ['--threads', threads], env });
  return readOutputs(path.join(folder, 'baked'));
}

function compare(what, expected, found) {
  const names = Object.keys(expected);
  checks.check(names.join() === Object.keys(found).join(), `${what}: wrote ${Object.keys(found)}, expected ${names}`);
  for (const name of names) if (found[name]) checks.check(expected[name].equals(found[name]), `${what}: ${name} differs`);
}

await withFolder((folder) => {
  try {
    const plain = { LC_ALL: 'C' };
    const german = germanEnvironment(path.join(folder, 'locales'));
    const expected = bakeIn(path.join(folder, 'a'), '1', plain);
    for (const ending of NEEDED)
      checks.check(Object.keys(expected).some((name) => name.endsWith(ending)), `no ${ending} was written`);
    console.log(Object.entries(expected).map(([name, bytes]) => `${name}: ${bytes.length} bytes`).join('\n'));
    compare('the same again', expected, bakeIn(path.join(folder, 'again'), '1', plain));
    compare('2 threads', expected, bakeIn(path.join(folder, 'b'), '2', plain));
    compare('another folder', expected, bakeIn(path.join(folder, 'somewhere', 'else entirely'), '2', plain));
    compare('de_DE.UTF-8', expected, bakeIn(path.join(folder, 'c'), '1', german));
  } catch (error) {
    checks.check(false, error.stack);
  }
});
checks.finish('the same bytes on 1 and 2 threads, in two folders, in C and de_DE.UTF-8');
