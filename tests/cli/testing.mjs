// What the scripts of this folder share: they run the program and tell all that is wrong.
import { spawnSync } from 'node:child_process';
import { mkdirSync, readdirSync, rmSync } from 'node:fs';

/** Tests of `program` in an empty folder, which becomes the current one. */
export function startTesting(program, scratch) {
  rmSync(scratch, { recursive: true, force: true });
  mkdirSync(scratch, { recursive: true });
  process.chdir(scratch);
  let wrong = 0;
  const check = (isRight, what) => {
    if (isRight) return;
    ++wrong;
    console.log(`WRONG: ${what}`);
  };
  return {
    check,
    /** Runs the program and checks its exit code: { stdout, stderr }. */
    run(code, words, env = {}) {
      const done = spawnSync(program, words, { encoding: 'utf8', maxBuffer: 1 << 28, env: { ...process.env, ...env } });
      check(done.status === code, `exit code ${done.status ?? done.signal} instead of ${code}: morphbake ${words.join(' ')}\n${done.stdout}${done.stderr}`);
      return done;
    },
    finish() {
      console.log(wrong ? `${wrong} wrong` : 'all right');
      process.exit(wrong ? 1 : 0);
    },
  };
}

/** All files below a folder, which need not exist. */
export function filesBelow(folder) {
  try {
    return readdirSync(folder, { recursive: true, withFileTypes: true }).filter((entry) => !entry.isDirectory()).map(({ name }) => name).sort();
  } catch (error) {
    if (error.code === 'ENOENT') return [];
    throw error;
  }
}
