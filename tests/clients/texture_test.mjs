// A texture that remesh paints shows at every point of the new surface what the source's own shows there.
// Usage: node texture_test.mjs --morphbake PROGRAM RECIPE    a recipe with connectivity.texture of its first source
import { spawnSync } from 'node:child_process';
import { readFileSync, writeFileSync } from 'node:fs';
import path from 'node:path';
import { countIssues } from './issues.mjs';
import { readPng } from './read_png.mjs';
import { openPlain } from './reference/plain.mjs';
import { add, cross, dot, length, scale, subtract, unit } from './reference/vectors.mjs';
import { bake, readArguments, startChecks, withFolder } from './support.mjs';

const POINTS = 600;
const SLACK = 4 / 255;  // of linear light beyond the colours that the source has within two texels

const { morphbake, files: [recipeFile] } = readArguments('morphbake');
const checks = startChecks();

const linear = (value) => (value <= 0.04045 ? value / 12.92 : ((value + 0.055) / 1.055) ** 2.4);
const mix = (rows, weights) => rows[0].map((_, c) => rows.reduce((sum, row, k) => sum + weights[k] * row[c], 0));

/** Numbers that are the same in every run (Numerical Recipes' generator). */
function randomNumbers(seed) {
  let state = seed;
  return () => (state = (Math.imul(state, 1664525) + 1013904223) >>> 0) / 2 ** 32;
}

/** An accessor's rows, as numbers of glTF: unsigned ones of colours and coordinates are normalised. */
function rows({ json, bin }, index) {
  const { bufferView, byteOffset = 0, componentType, count, type, normalized } = json.accessors[index];
  const view = json.bufferViews[bufferView];
  const columns = { SCALAR: 1, VEC2: 2, VEC3: 3, VEC4: 4 }[type];
  const [size, read, most] = { 5126: [4, 'getFloat32', 1], 5123: [2, 'getUint16', 65535], 5125: [4, 'getUint32', 1], 5121: [1, 'getUint8', 255] }[componentType];
  const data = new DataView(bin.buffer, bin.byteOffset, bin.byteLength);
  const begin = (view.byteOffset ?? 0) + byteOffset, stride = view.byteStride ?? size * columns;
  return Array.from({ length: count }, (_, i) => Array.from({ length: columns }, (__, c) =>
    data[read](begin + i * stride + c * size, true) / (normalized ? most : 1)));
}

/** All triangles of the first mesh with what colours them. */
function trianglesOf(plain) {
  const { json, images } = plain;
  const pictures = images.map(readPng);
  return json.meshes[0].primitives.flatMap(({ attributes, indices, material }) => {
    const { baseColorFactor = [1, 1, 1, 1], baseColorTexture } = json.materials?.[material]?.pbrMetallicRoughness ?? {};
    const positions = rows(plain, attributes.POSITION);
    const uvs = attributes.TEXCOORD_0 === undefined ? positions.map(() => [0, 0]) : rows(plain, attributes.TEXCOORD_0);
    const vertexColours = attributes.COLOR_0 === undefined ? positions.map(() => [1, 1, 1]) : rows(plain, attributes.COLOR_0);
    const order = indices === undefined ? positions.map((_, i) => i) : rows(plain, indices).flat();
    const picture = baseColorTexture && pictures[json.textures[baseColorTexture.index].source];
    return Array.from({ length: order.length / 3 }, (_, f) => {
      const at = order.slice(3 * f, 3 * f + 3);
      const corners = at.map((i) => positions[i]);
      const normal = cross(subtract(corners[1], corners[0]), subtract(corners[2], corners[0]));
      return {
        corners, normal, area: length(normal) / 2, picture, uv: at.map((i) => uvs[i]),
        colours: at.map((i) => vertexColours[i]), factor: baseColorFactor,
      };
    });
  });
}

function bilinear({ width, height, channels, pixels }, [u, v]) {
  const x = (u - Math.floor(u)) * width - 0.5, y = (v - Math.floor(v)) * height - 0.5;
  const [i, j] = [Math.floor(x), Math.floor(y)], [a, b] = [x - i, y - j];
  const texel = (column, row) => [0, 1, 2].map((c) =>
    linear(pixels[(((row + height) % height) * width + (column + width) % width) * channels + c] / 255));
  return mix([texel(i, j), texel(i + 1, j), texel(i, j + 1), texel(i + 1, j + 1)], [(1 - a) * (1 - b), a * (1 - b), (1 - a) * b, a * b]);
}

function colourOf({ uv, colours, picture, factor }, weights) {
  const texel = picture ? bilinear(picture, mix(uv, weights)) : [1, 1, 1];
  const vertex = mix(colours, weights);
  return texel.map((value, c) => value * vertex[c] * factor[c]);
}

/** Barycentric coordinates of the triangle's point closest to `p` (Ericson, Real-Time Collision Detection, 5.1.5). */
function closestIn([a, b, c], p) {
  const [ab, ac, ap] = [subtract(b, a), subtract(c, a), subtract(p, a)];
  const [d1, d2] = [dot(ab, ap), dot(ac, ap)];
  if (d1 <= 0 && d2 <= 0) return [1, 0, 0];
  const bp = subtract(p, b), [d3, d4] = [dot(ab, bp), dot(ac, bp)];
  if (d3 >= 0 && d4 <= d3) return [0, 1, 0];
  const vc = d1 * d4 - d3 * d2;
  if (vc <= 0 && d1 >= 0 && d3 <= 0) return [1 - d1 / (d1 - d3), d1 / (d1 - d3), 0];
  const cp = subtract(p, c), [d5, d6] = [dot(ab, cp), dot(ac, cp)];
  if (d6 >= 0 && d5 <= d6) return [0, 0, 1];
  const vb = d5 * d2 - d1 * d6;
  if (vb <= 0 && d2 >= 0 && d6 <= 0) return [1 - d2 / (d2 - d6), 0, d2 / (d2 - d6)];
  const va = d3 * d6 - d5 * d4;
  if (va <= 0 && d4 >= d3 && d5 >= d6) return [0, 1 - (d4 - d3) / (d4 - d3 + d5 - d6), (d4 - d3) / (d4 - d3 + d5 - d6)];
  return [va, vb, vc].map((share) => share / (va + vb + vc));
}

/** The source's colours at its points that face the same way and are closest to `places`, which are near to one another. */
function coloursNear(source, places, normal) {
  const facing = source.filter((triangle) => dot(triangle.normal, normal) > 0);
  return places.map((place) => {
    let best = { distance: Infinity };
    for (const triangle of facing) {
      if (length(subtract(triangle.corners[0], place)) - triangle.reach > best.distance) continue;
      const weights = closestIn(triangle.corners, place);
      const distance = length(subtract(mix(triangle.corners, weights), place));
      if (distance < best.distance) best = { distance, triangle, weights };
    }
    return colourOf(best.triangle, best.weights);
  });
}

/** `count` places of a surface, evenly by area. */
function drawPoints(surface, count, random) {
  const sums = [];
  for (const { area } of surface) sums.push((sums.at(-1) ?? 0) + area);
  return Array.from({ length: count }, () => {
    const wanted = random() * sums.at(-1);
    const [a, b] = [Math.sqrt(random()), random()];
    return { triangle: surface[sums.findIndex((sum) => sum >= wanted)], weights: [1 - a, a * (1 - b), a * b] };
  });
}

/** Width of a texel on the surface. */
function texelWidth({ uv, picture, area }) {
  const [a, b] = [1, 2].map((k) => [uv[k][0] - uv[0][0], uv[k][1] - uv[0][1]]);
  return Math.sqrt(area / (Math.abs(a[0] * b[1] - a[1] * b[0]) / 2 * picture.width * picture.height));
}

function compareColours(remeshed, source) {
  for (const triangle of source) {
    triangle.reach = Math.max(...triangle.corners.map((corner) => length(subtract(corner, triangle.corners[0]))));
  }
  let outside = 0, worst = 0, sum = 0;
  for (const { triangle, weights } of drawPoints(remeshed, POINTS, randomNumbers(1))) {
    const place = mix(triangle.corners, weights);
    const width = texelWidth(triangle);
    const x = unit(subtract(triangle.corners[1], triangle.corners[0])), y = unit(cross(triangle.normal, x));
    const around = [0.7, 1.4, 2].flatMap((radius) => Array.from({ length: 8 }, (_, i) => add(place, add(
      scale(x, radius * width * Math.cos(i * Math.PI / 4)), scale(y, radius * width * Math.sin(i * Math.PI / 4))))));
    const [own, ...others] = coloursNear(source, [place, ...around], triangle.normal);
    const found = colourOf(triangle, weights);
    const beyond = Math.max(...found.map((value, c) => {
      const range = [own, ...others].map((colour) => colour[c]);
      return Math.max(Math.min(...range) - value, value - Math.max(...range));
    }));
    worst = Math.max(worst, beyond);
    if (beyond > SLACK) ++outside;
    sum += Math.max(...found.map((value, c) => Math.abs(value - own[c])));
  }
  console.log(`${POINTS} points: mean difference ${(sum / POINTS).toFixed(4)}, beyond the colours around ${worst.toFixed(4)} at most, ${outside} of them`);
  checks.check(sum / POINTS < 0.01, `the colours differ by ${sum / POINTS}`);
  checks.check(outside === 0, `${outside} colours that the source has not there`);
}

async function checkFile(file, picture) {
  const issues = await countIssues(file);
  for (const [kind, { example }] of Object.entries(issues)) {
    checks.check(!/^(error|warning)/.test(kind), `${path.basename(file)}: ${kind}: ${example}`);
  }
  const plain = await openPlain(file);
  const { attributes, material } = plain.json.meshes[0].primitives[0];
  const { baseColorFactor = [1, 1, 1, 1], baseColorTexture } = plain.json.materials[material].pbrMetallicRoughness;
  checks.check(attributes.COLOR_0 === undefined, `${file}: COLOR_0 beside the texture`);
  checks.check(baseColorFactor.every((value) => value === 1) && baseColorTexture?.index === 0, `${file}: another material`);
  checks.check(plain.images.length === 1 && (!picture || Buffer.compare(plain.images[0], picture) === 0), `${file}: another picture`);
  const coordinates = rows(plain, attributes.TEXCOORD_0);
  checks.check(coordinates.flat().every((value) => value >= 0 && value <= 1), `${file}: coordinates beyond the square`);
  return plain;
}

const sameRows = (a, b) => JSON.stringify(a) === JSON.stringify(b);
const sorted = (lines) => lines.map(String).sort();
const texcoords = (plain) => rows(plain, plain.json.meshes[0].primitives[0].attributes.TEXCOORD_0);

/** Places with their normals, each once: what the texture splits is one of them. */
function shadedPoints({ json, bin }) {
  const { attributes } = json.meshes[0].primitives[0];
  const normals = rows({ json, bin }, attributes.NORMAL);
  return [...new Set(rows({ json, bin }, attributes.POSITION).map((place, i) => `${place} ${normals[i]}`))].sort();
}

function remesh(recipe, file, folder) {
  writeFileSync(file, JSON.stringify(recipe));
  const run = spawnSync(morphbake, ['remesh', file, '-o', folder, '--sheet', 'none'], { encoding: 'utf8' });
  return checks.check(run.status === 0, run.stderr);
}

await withFolder(async (folder) => {
  const recipe = JSON.parse(readFileSync(recipeFile, 'utf8'));
  for (const [name, file] of Object.entries(recipe.sources)) {
    const source = path.resolve(path.dirname(recipeFile), file);
    recipe.sources[name] = { file: source, landmarks: source.replace(/glb$/, 'landmarks.json') };
  }
  const plain = path.join(folder, 'plain');
  const untextured = { ...recipe, connectivity: { ...recipe.connectivity, texture: undefined } };
  if (!remesh(untextured, path.join(folder, 'plain.json'), plain)) return;
  if (!remesh(recipe, path.join(folder, 'textured.json'), folder)) return;
  const [first, second] = Object.keys(recipe.sources);
  const textured = await checkFile(path.join(folder, `${first}.glb`));
  const other = await checkFile(path.join(folder, `${second}.glb`), textured.images[0]);
  checks.check(sameRows(texcoords(textured), texcoords(other)), 'the sources have different coordinates');
  checks.check(sameRows(shadedPoints(textured), shadedPoints(await openPlain(path.join(plain, `${first}.glb`)))),
    'the texture changes places or normals');
  const source = await openPlain(recipe.sources[first].file);
  compareColours(trianglesOf(textured), trianglesOf(source));
  const { outputs: [{ file }] } = bake(morphbake, recipeFile, folder);
  const baked = await checkFile(file, textured.images[0]);
  checks.check(sameRows(sorted(texcoords(textured)), sorted(texcoords(baked))), 'the bake has different coordinates');
});
checks.finish('the texture shows the source');
