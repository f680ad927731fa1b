// node recipes.mjs FOLDER COUNT: a library of COUNT small recipes over forty connectivities, and its manifest FOLDER/library.jsonl.
import { mkdirSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { sphere, write_gltf } from '../cli/meshes.mjs';

const [folder, count] = [process.argv[2], Number(process.argv[3])];
mkdirSync(join(folder, 'recipes'), { recursive: true });
const connectivities = 40;
for (let k = 0; k < connectivities; ++k) {
  const across = 24 + 2 * (k % 10), along = 16 + Math.floor(k / 10);
  write_gltf(folder, `round_${k}`, sphere(across, along));
  write_gltf(folder, `pear_${k}`, sphere(across, along, ([x, y, z]) => [x * (1 - 0.4 * z), y * (1 - 0.4 * z), 1.3 * z]));
}

const lines = [];
for (let i = 0; i < count; ++i) {
  const k = i % connectivities;
  writeFileSync(join(folder, 'recipes', `r${i}.json`), JSON.stringify({
    version: 1, name: `r${i}`,
    sources: { round: `../round_${k}.gltf`, pear: `../pear_${k}.gltf` },
    regions: { top: { ball: { on: 'round', at: { vertex: 0 }, inner: 0.2 + 0.001 * i, outer: 1.2 } } },
    timeline: { tracks: [{ name: 'top', region: 'top', to: 'pear', begin: 0, end: 1 + 0.01 * i }] },
    preview: { turntable: { size: [64, 64], frames: 8 }, formats: ['sheet'] },
  }));
  lines.push(`${JSON.stringify(`recipes/r${i}.json`)}\n`);
}
writeFileSync(join(folder, 'library.jsonl'), lines.join(''));
