// Examples whose sources share their triangles: everything of the first source is kept, without a new issue.
// Usage: node examples_test.mjs --morphbake PROGRAM --output FOLDER RECIPE...    the files are left in FOLDER/<example>
import { readFileSync, rmSync } from 'node:fs';
import path from 'node:path';
import { countIssues, newIssues } from './issues.mjs';
import { findLost } from './kept.mjs';
import { openPlain } from './reference/plain.mjs';
import { bake, readArguments, startChecks } from './support.mjs';

const { morphbake, output, files } = readArguments('morphbake', 'output');
const checks = startChecks();
const isShared = ({ connectivity }) => (connectivity?.mode ?? 'shared') === 'shared';

async function testExample(recipeFile, recipe) {
  const example = path.basename(path.dirname(recipeFile));
  const folder = path.join(output, example);
  const { outputs: reports } = bake(morphbake, recipeFile, folder);
  const [first] = Object.values(recipe.sources);
  const source = path.resolve(path.dirname(recipeFile), first.file ?? first);
  const node = (await openPlain(source)).json.nodes.findIndex(({ mesh }) => mesh !== undefined);
  for (const [index, { file, still }] of (recipe.outputs ?? [{ file: `${recipe.name}.glb` }]).entries()) {
    const baked = path.join(folder, path.basename(file));
    // The base of a basis is no frame, so that no weight is below 0.
    const startsThere = !still && reports[index].kind !== 'basis';
    const lost = await findLost(source, baked, { node, startsThere, clips: still ? 0 : 1 });
    const issues = newIssues(await countIssues(source), await countIssues(baked));
    for (const problem of [...lost, ...issues]) checks.check(false, `${example}: ${path.basename(file)}: ${problem}`);
    console.log(`${example}: ${path.basename(file)}`);
  }
}

rmSync(output, { recursive: true, force: true });
for (const file of files) {
  const recipe = JSON.parse(readFileSync(file, 'utf8'));
  if (!isShared(recipe)) continue;
  try {
    await testExample(file, recipe);
  } catch (error) {
    checks.check(false, `${file}: ${error.stack}`);
  }
}
checks.finish('examples keep what their first source has');
