#!/usr/bin/env node
// Stands in for morphbake, to test the tests: bakes by the reference, with one fault on demand.
// Usage: STAND_IN_FAULT=<fault> stand_in.mjs bake RECIPE --output-dir DIR --report FILE [--preview none] [--threads N]
import { mkdirSync, readFileSync, writeFileSync } from 'node:fs';
import path from 'node:path';
import { parseArgs } from 'node:util';
import { findMeshNode, localMatrix, parseGlb } from './reference/glb.mjs';
import { at, cross, dot, scale, subtract, unit } from './reference/vectors.mjs';
import { cornersOf, expectOutput, openRecipe } from './reference_frames.mjs';
import { floats, packGlb } from './shapes/write_glb.mjs';

const fault = process.env.STAND_IN_FAULT ?? '';
const string = { type: 'string' };
const { values, positionals } = parseArgs({ allowPositionals: true,
  options: { 'output-dir': string, report: string, preview: string, threads: string } });

/** Scene space to the space of the source's mesh. */
function intoNode(matrix) {
  const [x, y, z, origin] = [0, 4, 8, 12].map((c) => matrix.slice(c, c + 3));
  const volume = dot(x, cross(y, z));
  const rows = [cross(y, z), cross(z, x), cross(x, y)].map((row) => scale(row, 1 / volume));
  return {
    point: (p) => rows.map((row) => dot(row, subtract(p, origin))),
    normal: (n) => unit([x, y, z].map((column) => dot(column, n))),
  };
}

const everyCorner = (values3, map) => Array.from({ length: values3.length / 3 }, (_, c) => map(at(values3, c)));
const differences = (rows, base) => rows.map((row, c) => subtract(row, base[c]));

/** One target a moment, each weighted 1 at its own time; corners are not shared. */
function writeOutput(opened, output, node) {
  const { times, shapes } = expectOutput(opened, output);
  const order = times.map((_, k) => k).sort((a, b) => times[a] - times[b]);
  const into = intoNode(localMatrix(node));
  const moments = order.map((k) => {
    const corners = cornersOf(opened, shapes[k]);
    return { POSITION: everyCorner(corners.positions, into.point),
      NORMAL: everyCorner(corners.normals, (n) => into.normal(n)) };
  });
  if (fault === 'position') moments.at(-1).POSITION[7][1] += 1e-3;
  if (fault === 'normal') moments[0].NORMAL[11] = unit([1, 2, 3]);
  if (fault === 'order') moments.forEach((moment) => moment.POSITION.reverse());
  return packMoments(moments, order.map((k) => times[k]), opened.sources[0].primitiveCorners, node);
}

function packMoments(moments, times, primitiveCorners, node) {
  const accessors = [];
  const put = (rows, width, target) => accessors.push(floats(rows, width, target)) - 1;
  let from = 0;
  const primitives = primitiveCorners.map((count) => {
    const slice = (rows) => rows.slice(from, from + count);
    const attributes = (moment, base) => Object.fromEntries(Object.entries(moment).map(([name, rows]) =>
      [name, put(slice(base ? differences(rows, base[name]) : rows), 3)]));
    const primitive = { attributes: attributes(moments[0]), targets: moments.slice(1).map((m) => attributes(m, moments[0])) };
    if (!primitive.targets.length) delete primitive.targets;
    from += count;
    return primitive;
  });
  const json = { scene: 0, scenes: [{ nodes: [0] }], nodes: [{ ...node, mesh: 0 }], meshes: [{ primitives }] };
  if (moments.length > 1) animate(json, put, times);
  return spoil(packGlb(json, accessors));
}

function animate(json, put, times) {
  const count = times.length - 1;
  const weights = times.flatMap((_, key) => Array.from({ length: count }, (__, k) => (k + 1 === key ? 1 : 0)));
  if (fault === 'weight') weights[0] = 1.25;
  json.meshes[0].weights = new Array(count).fill(0);
  json.meshes[0].extras = { targetNames: times.slice(1).map((t) => `at ${t}`) };
  if (fault === 'name') json.meshes[0].extras.targetNames[0] = '';
  const samplers = [{ input: put(times, 1, 0), output: put(weights, 1, 0) }];
  json.animations = [{ channels: [{ sampler: 0, target: { node: 0, path: 'weights' } }], samplers }];
}

/** The bounds of the first accessor, made wrong without changing a length. */
function spoil(bytes) {
  if (fault !== 'bounds') return bytes;
  const start = bytes.indexOf('"min":[') + 7;
  const digit = [...bytes.subarray(start, start + 20)].findIndex((c) => c >= 0x31 && c <= 0x39);
  bytes[start + digit] = bytes[start + digit] === 0x39 ? 0x38 : bytes[start + digit] + 1;
  return bytes;
}

const targetNames = (bytes) => parseGlb(bytes).json.meshes[0].extras?.targetNames ?? [];

function bakeLikeMorphbake(recipeFile) {
  const opened = openRecipe(recipeFile);
  const { sources, outputs } = opened.recipe;
  const first = Object.values(sources)[0];
  const { node } = findMeshNode(parseGlb(readFileSync(path.join(path.dirname(recipeFile), first.file ?? first))));
  const folder = values['output-dir'];
  mkdirSync(folder, { recursive: true });
  const reports = outputs.map((output) => {
    const bytes = writeOutput(opened, output, node);
    writeFileSync(path.join(folder, output.file), bytes);
    if (values.preview !== 'none') writePictures(path.join(folder, path.basename(output.file, '.glb')));
    return { file: output.file, targets: targetNames(bytes), max_error: 0, normals: { maximum: 0 } };
  });
  writeFileSync(values.report, JSON.stringify({ outputs: reports }));
}

function writePictures(stem) {
  writeFileSync(`${stem}.gif`, fault === 'threads' ? values.threads : 'a picture');
  writeFileSync(`${stem}.sheet.png`, fault === 'locale' ? (process.env.LC_ALL ?? '') : 'a picture');
}

bakeLikeMorphbake(positionals[1]);
