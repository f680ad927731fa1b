// Bakes recipes into FOLDER/<recipe>/ for the tests that look at files.
// Usage: node bake_recipes.mjs --morphbake PROGRAM --output FOLDER RECIPE...
import { rmSync } from 'node:fs';
import path from 'node:path';
import { bake, placeRecipe, readArguments, withFolder } from './support.mjs';

const { morphbake, output, files } = readArguments('morphbake', 'output');
rmSync(output, { recursive: true, force: true });  // no file of an older bake may pass for a new one
for (const file of files)
  await withFolder((folder) => bake(morphbake, placeRecipe(file, folder), path.join(output, path.basename(file, '.json'))));
console.log(`baked ${files.length} recipes into ${output}`);
