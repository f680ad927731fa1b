// Installs the npm packages of the client tests.
// Usage: node install_modules.mjs FOLDER    makes FOLDER/node_modules
import { fileURLToPath } from 'node:url';
import { spawnSync } from 'node:child_process';
import { copyFileSync, existsSync, mkdirSync, readFileSync, writeFileSync } from 'node:fs';
import path from 'node:path';

const here = path.dirname(fileURLToPath(import.meta.url));
const folder = process.argv[2];
const marker = path.join(folder, 'node_modules', '.installed-lock');
const lock = readFileSync(path.join(here, 'package-lock.json'), 'utf8');

// `npm ci` starts from nothing each time, which would need the network for every run of the tests.
if (existsSync(marker) && readFileSync(marker, 'utf8') === lock) process.exit(0);

mkdirSync(folder, { recursive: true });
for (const name of ['package.json', 'package-lock.json']) copyFileSync(path.join(here, name), path.join(folder, name));
const { status } = spawnSync('npm', ['ci', '--prefix', folder, '--ignore-scripts', '--no-audit', '--no-fund'],
  { stdio: 'inherit' });
if (status === 0) writeFileSync(marker, lock);
process.exit(status ?? 1);
