// The Khronos validator finds nothing wrong.
// Usage: node validator_test.mjs FILE_OR_FOLDER...
import { readFileSync } from 'node:fs';
import { findGlbs, readArguments, requireModule, startChecks } from './support.mjs';

const { files: names } = readArguments();
const checks = startChecks();
const validator = requireModule('gltf-validator');
const SEVERITIES = ['error', 'warning', 'info', 'hint'];

const files = findGlbs(names);
checks.check(files.length > 0, 'there is no file to validate');
for (const file of files) {
  const { issues } = await validator.validateBytes(new Uint8Array(readFileSync(file)), { maxIssues: 50 });
  for (const { severity, code, message, pointer } of issues.messages)
    console.log(`${file}#${pointer}: ${SEVERITIES[severity]}: ${message} [${code}]`);
  checks.check(!issues.truncated && issues.numErrors === 0, `${file}: ${issues.numErrors} errors`);
  checks.check(issues.numWarnings === 0, `${file}: ${issues.numWarnings} warnings`);
}
checks.finish(`${files.length} files without errors and warnings`);
