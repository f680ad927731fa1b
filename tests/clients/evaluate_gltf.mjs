// Evaluates a .glb by three.js' own code in a headless Chromium.
// Usage: node evaluate_gltf.mjs FILE.glb SECONDS PICTURE.png    draws one moment
import { readFileSync, writeFileSync } from 'node:fs';
import { pathToFileURL } from 'node:url';
import { openPage } from './browser.mjs';

/**
 * What three.js makes of a file at some times of its first clip, or of another (-1: the last).
 *
 * @return primitives: {count, indices} in the file's order; places: {node, mesh, primitive, vertices, targets} of each;
 *         clips, targets (names);
 *         positionsAt(k), normalsAt(k): at times[k], a list a primitive of #V by 3 values in world space
 *         (normals NaN where the file has none); complaints: what three.js or the page logged
 */
export async function evaluateGltf(browser, bytes, times, clip = 0) {
  await browser.page.waitForFunction('window.ready');
  browser.complaints.length = 0;
  const layout = await browser.page.evaluate(([url, at, which]) => window.evaluate(url, at, which), [browser.send(bytes), times, clip]);
  const primitives = layout.counts.map((count, k) => ({ count, indices: asArray(Uint32Array, browser.received[`indices/${k}`]) }));
  const positions = asArray(Float64Array, browser.received.positions);
  const normals = asArray(Float64Array, browser.received.normals);
  return { ...layout, primitives, complaints: [...browser.complaints],
    positionsAt: (k) => splitMoment(positions, layout.counts, k),
    normalsAt: (k) => splitMoment(normals, layout.counts, k) };
}

function asArray(type, buffer) {
  return new type(new Uint8Array(buffer).buffer);
}

function splitMoment(values, counts, moment) {
  const total = counts.reduce((sum, count) => sum + count, 0);
  let offset = 3 * total * moment;
  return counts.map((count) => values.subarray(offset, (offset += 3 * count)));
}

/** A picture (PNG) of one moment by WebGL. */
export async function drawGltf(browser, bytes, time, size = 512) {
  await browser.page.waitForFunction('window.ready');
  await browser.page.setViewportSize({ width: size, height: size });
  await browser.page.evaluate(([url, at, pixels]) => window.show(url, at, pixels), [browser.send(bytes), time, size]);
  return browser.page.screenshot();
}

async function draw(file, time, picture) {
  const browser = await openPage();
  writeFileSync(picture, await drawGltf(browser, readFileSync(file), Number(time)));
  for (const complaint of browser.complaints) console.log(complaint);
  await browser.close();
}

if (import.meta.url === pathToFileURL(process.argv[1] ?? '').href) await draw(...process.argv.slice(2));
