// With `hold`, the targets of a file move vertices of the regions and no others, by exact zeros.
// Usage: node hold_test.mjs --morphbake PROGRAM RECIPE
import { existsSync, readFileSync, writeFileSync } from 'node:fs';
import { spawnSync } from 'node:child_process';
import path from 'node:path';
import { findMeshNode, parseGlb, readAccessor, readTriangles } from './reference/glb.mjs';
import { openRecipe } from './reference_frames.mjs';
import { startChecks, withFolder } from './support.mjs';

const checks = startChecks();
const program = process.argv[process.argv.indexOf('--morphbake') + 1];
const recipeFile = path.resolve(process.argv.at(-1));

/** The recipe with `hold` and absolute sources, in `folder`; null when a source is not there. */
function heldRecipe(folder) {
  const recipe = JSON.parse(readFileSync(recipeFile, 'utf8'));
  for (const [name, source] of Object.entries(recipe.sources)) {
    const file = path.resolve(path.dirname(recipeFile), source.file ?? source);
    if (!existsSync(file)) return null;
    recipe.sources[name] = source.file ? { ...source, file } : file;
  }
  recipe.hold = 'auto';
  const file = path.join(folder, 'held.json');
  writeFileSync(file, JSON.stringify(recipe));
  return file;
}

await withFolder((folder) => {
  const file = heldRecipe(folder);
  if (!file) {
    console.log('skipped: a source of the recipe is not there');
    process.exit(77);
  }
  const baked = spawnSync(program, ['bake', file, '--preview', 'none', '-o', folder], { encoding: 'utf8' });
  checks.check(baked.status === 0, `bake: ${baked.stderr}`);
  const { recipe, mesh, fields } = openRecipe(file);
  const output = recipe.outputs.find((each) => !each.still);
  const glb = parseGlb(readFileSync(path.join(folder, path.basename(output.file))));
  const primitive = glb.json.meshes[findMeshNode(glb).node.mesh].primitives[0];
  const target = readAccessor(glb, primitive.targets[0].POSITION);
  const rows = Array.from({ length: target.length / 3 }, (_, i) => target.subarray(3 * i, 3 * i + 3));
  const d = Object.values(fields)[0];
  const indices = readTriangles(glb, primitive);
  const outside = new Set();
  const inside = new Set();
  mesh.corners.forEach((vertex, corner) => (d[vertex] >= 1 ? outside : inside).add(indices[corner]));
  const moving = rows.map((row, i) => (row.some((x) => x !== 0) ? i : -1)).filter((i) => i >= 0);
  const strays = moving.filter((i) => outside.has(i) && !inside.has(i));
  console.log(`${moving.length} of ${rows.length} vertices move; the region has ${inside.size}`);
  checks.check(moving.length > 0 && moving.length <= inside.size, 'more vertices move than the region has');
  checks.check(strays.length === 0, `${strays.length} vertices outside the region move`);
});
checks.finish('held vertices');
