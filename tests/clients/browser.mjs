// A headless Chromium and the small server of its page.
import { fileURLToPath } from 'node:url';
import { existsSync, readFileSync } from 'node:fs';
import { createServer } from 'node:http';
import path from 'node:path';
import { modulesFolder, requireModule, skip } from './support.mjs';

export const PROGRAM = process.env.MORPHBAKE_CHROMIUM ?? '/usr/bin/chromium';
export const SWITCHES = ['--no-sandbox', '--disable-gpu', '--disable-quic', '--no-first-run', '--disable-background-networking',
  '--disable-component-update', '--disable-sync', '--use-gl=angle', '--use-angle=swiftshader',
  '--enable-unsafe-swiftshader'];
const TYPES = { '.html': 'text/html', '.js': 'text/javascript', '.mjs': 'text/javascript', '.glb': 'model/gltf-binary' };

/**
 * Opens a page of page/.
 *
 * @return page: playwright's; send(bytes): a URL under which the page finds them;
 *         received: what the page posted, a Buffer a name; close()
 */
export async function openPage(name = 'evaluate.html') {
  if (!existsSync(PROGRAM)) skip(`${PROGRAM} is not installed (apt-get install chromium)`);
  const exchange = { sent: [], received: {} };
  const server = createServer((request, response) => answer(exchange, request, response));
  await new Promise((ready) => server.listen(0, '127.0.0.1', ready));
  const browser = await requireModule('playwright-core').chromium.launch({ executablePath: PROGRAM, args: SWITCHES });
  const page = await browser.newPage();
  const complaints = [];
  page.on('pageerror', (error) => complaints.push(String(error)));
  page.on('console', (line) => { if (['error', 'warning'].includes(line.type())) complaints.push(line.text()); });
  await page.goto(`http://127.0.0.1:${server.address().port}/page/${name}`);
  return {
    page, complaints, received: exchange.received,
    send: (bytes) => `/sent/${exchange.sent.push(bytes) - 1}.glb`,
    async close() {
      await browser.close();
      server.close();
    },
  };
}

async function answer(exchange, request, response) {
  const [, area, ...rest] = decodeURIComponent(request.url).split('/');
  try {
    if (request.method === 'POST') {
      const parts = [];
      for await (const part of request) parts.push(part);
      exchange.received[rest.join('/')] = Buffer.concat(parts);
      return response.end();
    }
    const body = area === 'sent' ? exchange.sent[parseInt(rest[0], 10)] : readFileSync(locate(area, rest));
    response.setHeader('Content-Type', TYPES[path.extname(request.url)] ?? 'application/octet-stream');
    response.end(body);
  } catch {
    response.statusCode = 404;
    response.end();
  }
}

function locate(area, rest) {
  if (area === 'page') return path.join(path.dirname(fileURLToPath(import.meta.url)), 'page', ...rest);
  if (area === 'modules') return path.join(modulesFolder(), ...rest);
  throw new Error('no such area');
}
