// What the Khronos validator says of a file, counted, to be compared with what it said of another.
import { readFileSync } from 'node:fs';
import path from 'node:path';
import { requireModule } from './support.mjs';

const SEVERITIES = ['error', 'warning', 'info', 'hint'];

/** {"error: CODE": {count, example}} of a .gltf or .glb with what lies beside it. */
export async function countIssues(file) {
  const read = async (uri) => new Uint8Array(readFileSync(path.join(path.dirname(file), decodeURIComponent(uri))));
  const { issues } = await requireModule('gltf-validator').validateBytes(new Uint8Array(readFileSync(file)),
    { uri: encodeURIComponent(path.basename(file)), maxIssues: 0, externalResourceFunction: read });
  const counted = {};
  for (const { severity, code, message, pointer } of issues.messages) {
    const kind = `${SEVERITIES[severity]}: ${code}`;
    counted[kind] ??= { count: 0, example: `${pointer}: ${message}` };
    counted[kind].count++;
  }
  return counted;
}

/** Of each kind of issue those that `after` has more of than `before`, in words. */
export const newIssues = (before, after) => Object.entries(after)
  .filter(([kind, { count }]) => count > (before[kind]?.count ?? 0))
  .map(([kind, { count, example }]) => `${kind}: ${count}, the source has ${before[kind]?.count ?? 0}; ${example}`);

export const errorsIn = (issues) => Object.entries(issues).filter(([kind]) => kind.startsWith('error'))
  .map(([kind, { example }]) => `${kind}: ${example}`);
