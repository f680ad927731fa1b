// `morphbake lint` objects to nothing in files that the profile's client reads, whoever wrote them.
// Usage: node lint_test.mjs --morphbake PROGRAM --profile NAME FILE_OR_FOLDER...
import { spawnSync } from 'node:child_process';
import path from 'node:path';
import { findGlbs, readArguments, startChecks } from './support.mjs';

const { morphbake, profile, files: names } = readArguments('morphbake', 'profile');
const checks = startChecks();

function checkFile(file) {
  const { status, stdout, stderr } = spawnSync(morphbake, ['lint', file, '--profile', profile, '--json'],
    { encoding: 'utf8', maxBuffer: 1 << 28 });
  if (!checks.check(status === 0 || status === 1, `${file}: exit code ${status}: ${stderr}`)) return;
  const { errors, warnings, findings } = JSON.parse(stdout);
  const found = findings.filter(({ severity }) => severity === 'error').map(({ rule }) => rule);
  checks.check(found.length === 0, `${file}: ${found.join(', ')}`);
  checks.check(status === (errors ? 1 : 0), `${file}: exit code ${status} with ${errors} errors`);
  console.log(`${path.basename(file)}: ${errors} errors, ${warnings} warnings, ${findings.length} findings`);
}

const files = findGlbs(names);
checks.check(files.length > 0, 'there is no file to look at');
for (const file of files) checkFile(file);
checks.finish(`${profile}: ${files.length} files`);
