// Sources that are not connected alike: what bake, remesh and validate say, and the picture that is all they leave.
//
//   node mismatch.mjs MORPHBAKE SCRATCH
import { spawnSync } from 'node:child_process';
import { existsSync, mkdirSync, readdirSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { inflateSync } from 'node:zlib';
import { sphere, write_gltf } from './meshes.mjs';

const [program, scratch] = process.argv.slice(2);
const SLOWNESS = 'LSAN_OPTIONS' in process.env ? 5 : 1;  // of the sanitizers
let failures = 0;
const wrong = (text) => { console.log(`WRONG: ${text}`); ++failures; };

/** The pixels of an 8-bit RGB PNG. */
function read_png(file) {
  const bytes = readFileSync(file);
  if (bytes.toString('latin1', 0, 8) !== '\x89PNG\r\n\x1a\n') throw new Error('no PNG');
  let width, height;
  const data = [];
  for (let at = 8; at < bytes.length; at += 12 + bytes.readUInt32BE(at)) {
    const type = bytes.toString('latin1', at + 4, at + 8), length = bytes.readUInt32BE(at);
    if (type === 'IDAT') data.push(bytes.subarray(at + 8, at + 8 + length));
    if (type !== 'IHDR') continue;
    [width, height] = [bytes.readUInt32BE(at + 8), bytes.readUInt32BE(at + 12)];
    if (bytes[at + 16] !== 8 || bytes[at + 17] !== 2) throw new Error('not 8-bit RGB');
  }
  const packed = inflateSync(Buffer.concat(data)), stride = 3 * width, pixels = Buffer.alloc(stride * height);
  for (let y = 0; y < height; ++y) {
    const filter = packed[y * (stride + 1)];
    for (let x = 0; x < stride; ++x) {
      const left = x < 3 ? 0 : pixels[y * stride + x - 3], up = y ? pixels[(y - 1) * stride + x] : 0;
      const corner = x < 3 || !y ? 0 : pixels[(y - 1) * stride + x - 3];
      const [a, b, c] = [left, up, corner].map((near) => Math.abs(left + up - corner - near));
      const paeth = a <= b && a <= c ? left : b <= c ? up : corner;
      pixels[y * stride + x] = packed[y * (stride + 1) + 1 + x] + [0, left, up, (left + up) >> 1, paeth][filter];
    }
  }
  return { width, height, pixels };
}

/** How many pixels are clearly red, on the left and on the right half. */
function reds({ width, height, pixels }) {
  const count = [0, 0];
  for (let i = 0; i < width * height; ++i) {
    const [r, g, b] = pixels.subarray(3 * i, 3 * i + 3);
    if (r > 90 && r > 2 * g && r > 2 * b) ++count[i % width < width / 2 ? 0 : 1];
  }
  return count;
}

function recipe(name, a, b, connectivity) {
  const folder = join(scratch, name);
  mkdirSync(folder, { recursive: true });
  write_gltf(folder, 'a', a);
  write_gltf(folder, 'b', b);
  const file = join(folder, 'recipe.json');
  writeFileSync(file, JSON.stringify({
    version: 1, name: 'two', sources: { a: { file: 'a.gltf' }, b: { file: 'b.gltf' } }, connectivity,
    outputs: [{ file: 'morph.glb' }, { file: 'again.glb' }],
    timeline: { tracks: [{ name: 't', to: 'b', begin: 0, end: 1 }] },
  }));
  return file;
}

function refused(name, command, parts) {
  const run = spawnSync(program, command, { encoding: 'utf8', timeout: SLOWNESS * 60000 });
  if (run.status !== 4) wrong(`${name}: ${command[0]}: exit code ${run.status}, not 4\n${run.stderr}`);
  const missing = parts.filter((part) => !run.stderr.includes(part));
  if (missing.length) wrong(`${name}: ${command[0]} does not say ${missing.join(' | ')}\n${run.stderr}`);
  return run.stderr;
}

const files_in = (folder) => (existsSync(folder) ? readdirSync(folder) : []);

/** One PNG and nothing else, with red on the sides that are said to have some. */
function only_picture(name, folder, picture, sides) {
  const found = files_in(folder);
  if (found.length !== 1 || found[0] !== picture) return wrong(`${name}: left ${found.join(', ') || 'nothing'}`);
  const count = reds(read_png(join(folder, picture)));
  for (const side of [0, 1]) {
    if (sides[side] !== count[side] > 100) wrong(`${name}: ${count[side]} red pixels on side ${side}`);
  }
}

rmSync(scratch, { recursive: true, force: true });

const ball = sphere(24, 16);
const egg = sphere(24, 16, ([x, y, z]) => [x * (1 + 0.3 * z), 0.8 * y, 1.4 * z]);
/** Every triangle with vertices of its own: the surface is the same. */
const soup = ({ points, faces }) => ({ points: faces.flatMap((face) => face.map((v) => points[v])), faces: faces.map((_, f) => [3 * f, 3 * f + 1, 3 * f + 2]) });
const holed = soup({ points: egg.points, faces: egg.faces.filter((_, f) => f < 308 || f > 311) });
/** The other diagonal of the quad of two triangles. */
const flipped = ({ points, faces }, f) => {
  const [a, b, c] = faces[f], d = faces[f + 1][2];
  return { points, faces: [...faces.slice(0, f), [a, b, d], [b, c, d], ...faces.slice(f + 2)] };
};

// How the files split vertices does not matter.
const alike = recipe('alike', ball, soup(egg));
const out = (name) => join(scratch, name, 'out');
const run = spawnSync(program, ['bake', alike, '--output-dir', out('alike')], { encoding: 'utf8', timeout: SLOWNESS * 60000 });
if (run.status !== 0) wrong(`alike: exit code ${run.status}\n${run.stderr}`);
if (files_in(out('alike')).sort().join() !== 'again.glb,morph.glb') wrong(`alike: wrote ${files_in(out('alike'))}`);

// A patch that one source lacks.
const lacking = ['b.gltf#/meshes/0: error: "b" has 716 triangles but "a" has 720; first at (', ') in "a", (', '[connectivity.different-triangles]'];
const patch = recipe('patch', ball, holed);
refused('patch', ['bake', patch, '--output-dir', out('patch')], [...lacking, `hint: ${join(out('patch'), 'morph.mismatch.png')} shows where; `]);
only_picture('patch', out('patch'), 'morph.mismatch.png', [true, true]);
rmSync(out('patch'), { recursive: true });
const told = refused('patch', ['validate', patch], lacking);
if (told.includes('png')) wrong(`patch: validate names a picture\n${told}`);
if (files_in(join(scratch, 'patch')).some((file) => file.endsWith('.png'))) wrong('patch: validate drew a picture');

// Equally many triangles, one pair of them on the other diagonal.
const edge = recipe('edge', ball, soup(flipped(egg, 308)));
const crossing = ['"b" and "a" are not connected alike: ', ' triangles have other neighbours; first at (', '[connectivity.different-topology]'];
refused('edge', ['bake', edge, '--output-dir', out('edge')], [...crossing, 'morph.mismatch.png shows where']);
only_picture('edge', out('edge'), 'morph.mismatch.png', [true, true]);

// A piece that only one source has; `remesh` draws too, under the recipe's name.
const end = egg.points.length;
const piece = { points: [...egg.points, [2, 0, 0], [2.5, 0, 0], [2, 0.5, 0]], faces: [...egg.faces, [end, end + 1, end + 2]] };
const resampled = recipe('piece', ball, piece, { mode: 'resample' });
for (const command of [['remesh', resampled, '-o', out('piece')], ['bake', resampled, '--output-dir', join(scratch, 'piece', 'baked')]]) {
  refused('piece', command, ['"b" has 721 triangles but "a" has 720; first at (', ') in "b" only [connectivity.different-triangles]']);
}
only_picture('piece', out('piece'), 'two.mismatch.png', [false, true]);
only_picture('piece', join(scratch, 'piece', 'baked'), 'morph.mismatch.png', [false, true]);

// No picture where none can be written, but what is wrong is told first.
const blocked = recipe('blocked', ball, holed);
writeFileSync(out('blocked'), 'a file where a folder is needed');
refused('blocked', ['bake', blocked, '--output-dir', out('blocked')], [...lacking, '[output.unwritable]']);

console.log(failures ? `${failures} wrong` : 'all right');
process.exit(failures ? 1 : 0);
