// node landmarks.mjs PROGRAM FOLDER DOCS COMMAND: which suggestions of `morphbake landmarks suggest` are right, on pairs of
// real meshes whose landmarks were set by hand. Writes DOCS/landmarks-measured.md.
import { spawnSync } from 'node:child_process';
import { mkdtempSync, readFileSync, readdirSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { basename, join } from 'node:path';
import { parseGlb, readAccessor } from '../clients/reference/glb.mjs';

const [program, meshes, docs, command] = process.argv.slice(2);
const scratch = mkdtempSync(join(tmpdir(), 'morphbake-bench-'));
process.on('exit', () => rmSync(scratch, { recursive: true, force: true }));
const NEAR = 0.07;  // of the diagonal: how near to a hand-made landmark a suggestion is one

const distance = (a, b) => Math.hypot(...a.map((x, i) => x - b[i]));

function diagonal(file) {
  const glb = parseGlb(readFileSync(file));
  const points = glb.json.meshes[0].primitives.map((primitive) => readAccessor(glb, primitive.attributes.POSITION));
  const range = (c) => points.flatMap((flat) => flat.reduce(([low, high], x, i) =>
    (i % 3 === c ? [Math.min(low, x), Math.max(high, x)] : [low, high]), [Infinity, -Infinity]));
  return Math.hypot(...[0, 1, 2].map((c) => Math.max(...range(c)) - Math.min(...range(c))));
}

/** Right: near one landmark on both sides. Wrong: near it on one side, twice as far away on the other. */
function judge(places, pair, size) {
  const away = (mark, which) => distance(places[which], mark[which]) / size[which];
  if (pair.landmarks.some((mark) => away(mark, 'a') < NEAR && away(mark, 'b') < NEAR)) return 'right';
  const isWrong = pair.landmarks.some((mark) => Math.min(away(mark, 'a'), away(mark, 'b')) < NEAR &&
    Math.max(away(mark, 'a'), away(mark, 'b')) > 2 * NEAR);
  return isWrong ? 'wrong' : 'open';
}

function measure(file) {
  const pair = JSON.parse(readFileSync(join(meshes, file), 'utf8'));
  const [a, b] = [join(meshes, pair.a), join(meshes, pair.b)];
  const run = spawnSync(program, ['landmarks', 'suggest', a, b, '-o', scratch, '--force'], { encoding: 'utf8' });
  if (run.status !== 0) throw new Error(run.stderr);
  const read = (name) => JSON.parse(readFileSync(join(scratch, `${basename(name, '.glb')}.landmarks.json`), 'utf8')).landmarks;
  const suggested = { a: read(pair.a), b: read(pair.b) };
  const size = { a: diagonal(a), b: diagonal(b) };
  const counts = { right: 0, wrong: 0, open: 0 };
  for (const name of Object.keys(suggested.a)) {
    counts[judge({ a: suggested.a[name].position, b: suggested.b[name].position }, pair, size)] += 1;
  }
  return { name: file.slice(5, -5), ...counts, warns: run.stderr.includes('[landmarks.uncertain]') };
}

const rows = readdirSync(meshes).filter((file) => /^pair-.*\.json$/.test(file)).sort().map(measure);
writeFileSync(join(docs, 'landmarks-measured.md'), `${[
  '# How good suggested landmarks are', '',
  `Measured by \`${command}\`, ${new Date().toISOString().slice(0, 10)}: \`morphbake landmarks suggest\` on pairs of real meshes`,
  `with landmarks set by hand. Right: within ${Math.round(100 * NEAR)} % of the diagonal of one of these on both meshes; wrong: so near on one`,
  'mesh and twice as far away on the other; the others are near none, so nobody said what they should be. The limits of',
  'suggesting, and from where on it warns (`landmarks.uncertain`), were chosen while looking at these pairs: expect less of others.',
  '', '| pair | right | wrong | not judged | warns |', '|---|---:|---:|---:|---|',
  ...rows.map((row) => `| ${row.name} | ${row.right} | ${row.wrong} | ${row.open} | ${row.warns ? 'yes' : 'no'} |`),
].join('\n')}\n`);
