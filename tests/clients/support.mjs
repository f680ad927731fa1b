// What every test here needs: arguments, npm packages, folders, verdicts.
import { spawnSync } from 'node:child_process';
import { copyFileSync, existsSync, mkdirSync, mkdtempSync, readdirSync, readFileSync, rmSync, statSync } from 'node:fs';
import { createRequire } from 'node:module';
import { tmpdir } from 'node:os';
import path from 'node:path';
import { parseArgs } from 'node:util';
import { makeShape } from './shapes/make_shapes.mjs';

/** `--name value` options (all strings) and the remaining arguments. */
export function readArguments(...names) {
  const options = Object.fromEntries(names.map((name) => [name, { type: 'string' }]));
  const { values, positionals } = parseArgs({ options, allowPositionals: true });
  for (const name of names) if (values[name] === undefined) stop(2, `missing --${name}`);
  return { ...values, files: positionals };
}

function stop(code, message) {
  console.error(message);
  process.exit(code);
}

/** Folder of the installed npm packages. */
export function modulesFolder() {
  const folder = process.env.MORPHBAKE_CLIENT_MODULES;
  if (!folder) stop(2, 'set MORPHBAKE_CLIENT_MODULES to the node_modules that install_modules.mjs made');
  return path.resolve(folder);
}

export const requireModule = (name) => createRequire(path.join(modulesFolder(), 'any.js'))(name);

/** Ends the test as skipped: ctest knows 77. */
export function skip(reason) {
  console.log(`SKIPPED: ${reason}`);
  process.exit(77);
}

/** Collects failures; `finish` prints the verdict and ends the process. */
export function startChecks() {
  const failures = [];
  return {
    check(holds, message) {
      if (!holds) failures.push(message);
      return holds;
    },
    finish(summary) {
      for (const failure of failures) console.log(`FAILED: ${failure}`);
      console.log(failures.length ? `${failures.length} failures` : `passed: ${summary}`);
      process.exit(failures.length ? 1 : 0);
    },
  };
}

/** Runs `work` with a fresh folder that is removed afterwards. */
export async function withFolder(work) {
  const folder = mkdtempSync(path.join(tmpdir(), 'morphbake-clients-'));
  try {
    return await work(folder);
  } finally {
    rmSync(folder, { recursive: true, force: true });
  }
}

/**
 * Copies a recipe and its sources into `folder`; sources that do not exist are generated.
 *
 * @return the copy's file name
 */
export function placeRecipe(recipeFile, folder) {
  const recipe = JSON.parse(readFileSync(recipeFile, 'utf8'));
  mkdirSync(folder, { recursive: true });
  for (const source of Object.values(recipe.sources)) placeSource(source.file ?? source, path.dirname(recipeFile), folder);
  const copy = path.join(folder, path.basename(recipeFile));
  copyFileSync(recipeFile, copy);
  return copy;
}

function placeSource(name, from, folder) {
  if (!existsSync(path.join(from, name))) return makeShape(name, folder);
  const landmarks = name.replace(/\.[^.]*$/, '.landmarks.json');
  for (const file of [name, landmarks])
    if (existsSync(path.join(from, file))) copyFileSync(path.join(from, file), path.join(folder, file));
}

/** Bakes a recipe by the command line; throws with its stderr when it fails. @return the report */
export function bake(program, recipeFile, folder, { preview = 'none', args = [], env = {} } = {}) {
  const report = path.join(folder, 'report.json');
  mkdirSync(folder, { recursive: true });
  const words = ['bake', recipeFile, '--output-dir', folder, '--report', report, ...args];
  if (preview === 'none') words.push('--preview', 'none');
  const run = spawnSync(program, words, { encoding: 'utf8', env: { ...process.env, ...env } });
  if (run.error) throw run.error;
  if (run.status !== 0) throw new Error(`${program} ${words.join(' ')} ended with ${run.status}\n${run.stderr}`);
  return JSON.parse(readFileSync(report, 'utf8'));
}

/** The .glb files among `names`: files as they are, folders searched to the bottom. */
export function findGlbs(names) {
  return names.flatMap((name) => {
    if (!existsSync(name)) skip(`${name} is not there: what makes it was skipped`);
    if (!statSync(name).isDirectory()) return [name];
    return readdirSync(name, { recursive: true }).filter((file) => file.endsWith('.glb')).sort()
      .map((file) => path.join(name, file));
  });
}
