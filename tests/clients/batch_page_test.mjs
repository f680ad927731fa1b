// The page of a library (`morphbake batch --html`) from disk: shows its pictures, sorts, filters, and asks nobody else.
// Usage: node batch_page_test.mjs --morphbake PROGRAM --output FOLDER --examples FOLDER
import { spawnSync } from 'node:child_process';
import { existsSync, mkdirSync, rmSync, writeFileSync } from 'node:fs';
import path from 'node:path';
import { pathToFileURL } from 'node:url';
import { PROGRAM, SWITCHES } from './browser.mjs';
import { readArguments, requireModule, skip, startChecks } from './support.mjs';

const { morphbake, output, examples } = readArguments('morphbake', 'output', 'examples');
if (!existsSync(PROGRAM)) skip(`${PROGRAM} is not installed (apt-get install chromium)`);
const { check, finish } = startChecks();

// Some examples, and the names and problems of the first once more.
rmSync(output, { recursive: true, force: true });
mkdirSync(output, { recursive: true });
const sheet = { '/preview': { turntable: { size: [160, 160], frames: 4 }, formats: ['sheet'] } };
const nose = path.resolve(examples, '01_nose/recipe.json');
const ODD = 'odd " & <i>name</i> %23 # ? \u00e4\u9f3b';
const list = [
  { recipe: nose, name: 'b/nose', set: sheet },
  { recipe: nose, name: ODD, set: { ...sheet, '/timeline/tracks/0/end': 1 } },
  { recipe: nose, name: 'a/no pictures', set: { '/preview': { formats: ['sheet'], turntable: { size: [64, 64], frames: 1 } } } },
  { recipe: nose, name: 'c/fails', set: { '/timeline/tracks/0/to': '<script>document.title = "no"</script>' } },
  { recipe: path.resolve(examples, '07_cow_to_pig/recipe.json'), name: 'farm', set: sheet },
].filter(({ recipe }) => existsSync(recipe));
writeFileSync(path.join(output, 'list.jsonl'), list.map((line) => JSON.stringify(line)).join('\n'));
const done = spawnSync(morphbake, ['batch', path.join(output, 'list.jsonl'), '-o', path.join(output, 'out'), '--html', '--cache', path.join(output, 'cache')], { encoding: 'utf8' });
check(done.status === 3, `morphbake batch: ${done.status} ${done.stderr}`);

const browser = await requireModule('playwright-core').chromium.launch({ executablePath: PROGRAM, args: SWITCHES });
for (const colorScheme of ['light', 'dark']) {
  const page = await browser.newPage({ colorScheme, viewport: { width: 1300, height: 900 } });
  const complaints = [], requests = [];
  page.on('pageerror', (error) => complaints.push(String(error)));
  page.on('console', (line) => complaints.push(line.text()));
  page.on('request', (request) => requests.push(request.url()));
  await page.goto(String(pathToFileURL(path.resolve(output, 'out/index.html'))));
  await page.waitForLoadState('networkidle');
  const names = () => page.$$eval('tbody tr:not([hidden]) td.name b', (all) => all.map((each) => each.textContent));
  check((await names()).join('|') === list.map(({ name }) => name).join('|'), `rows: ${await names()}`);
  const sizes = await page.$$eval('img', (all) => all.map((image) => image.naturalWidth));
  check(sizes.length === list.length - 1 && sizes.every((size) => size > 0), `pictures: ${sizes}`);
  check(await page.title() === 'Library of morphs', 'a name was run as a script');
  check(requests.every((url) => url.startsWith('file:')), `asks for ${requests}`);
  check(complaints.length === 0, `complains: ${complaints}`);
  await page.screenshot({ path: path.join(output, `page-${colorScheme}.png`) });

  await page.click('th button:text("name")');
  check((await names())[0] === 'a/no pictures', `sorted by name: ${await names()}`);
  const numbers = () => page.$$eval('tbody tr td:nth-child(6)', (all) => all.map((cell) => cell.dataset.v).filter(Boolean).map(Number));
  for (const turn of [1, -1]) {
    await page.click('th button:text("bytes")');
    const bytes = await numbers();
    check(bytes.length === list.length - 1 && bytes.every((each, i) => i === 0 || turn * (each - bytes[i - 1]) >= 0), `sorted by bytes: ${bytes}`);
    check((await names()).at(-1) === 'c/fails', 'what has no value is not last');
  }
  await page.selectOption('#state', 'failed');
  check((await names()).join() === 'c/fails', `failed: ${await names()}`);
  check((await page.textContent('tr:not([hidden]) .error')).includes('[recipe.unknown-name]'), 'the error is not told');
  await page.selectOption('#state', '');
  await page.fill('#words', 'NAME</i>');
  check((await names()).join() === ODD, `filtered: ${await names()}`);
  check(await page.textContent('#shown') === '1', 'how many are shown');
  const link = await page.getAttribute('tr:not([hidden]) td.name a', 'href');
  check(existsSync(path.join(output, 'out', decodeURIComponent(link))), `links to ${link}`);
  await page.close();
}
await browser.close();
finish(`a page of ${list.length} recipes, light and dark`);
