# What the tests of this folder share: `. library.sh`. Arguments of each: PROGRAM ROOT SCRATCH. 77 is a test that was skipped.
set -u
export MORPHBAKE=$1
root=$2 scratch=$3 failures=0
wrong() { echo "WRONG: $*"; failures=$((failures + 1)); }
skip() { echo "SKIPPED: $*"; exit 77; }
finish() { [ $failures = 0 ] && echo "all right"; exit $((failures > 0)); }

make_library() { # FOLDER COUNT
  rm -rf "$1" && node "$root/tests/library/recipes.mjs" "$1" "$2" || exit 1
}

library() { # CODE ARGUMENTS...: runs pipeline/library; leaves $scratch/stdout and stderr
  local expected=$1 status=0
  shift
  "$root/pipeline/library" "$@" >"$scratch/stdout" 2>"$scratch/stderr" </dev/null || status=$?
  [ $status = "$expected" ] || { wrong "exit code $status instead of $expected: pipeline/library $*"; cat "$scratch/stderr"; }
}

stderr_has() { grep -qE -e "$1" "$scratch/stderr" || { wrong "stderr lacks: $1"; cat "$scratch/stderr"; }; }
stderr_lacks() { ! grep -qE -e "$1" "$scratch/stderr" || { wrong "stderr has: $1"; cat "$scratch/stderr"; }; }

# What was baked, without reports, page and state: times stand in those.
results_of() { (cd -- "$1" && find . -mindepth 2 -type f -not -path './.*' -print0 | sort -z | xargs -0 sha256sum); }

same_results() { # DIR DIR COUNT: byte for byte, and of COUNT recipes
  local glbs
  diff <(results_of "$1") <(results_of "$2") >"$scratch/difference" || { wrong "$1 and $2 differ"; head -n 20 "$scratch/difference"; }
  glbs=$(find "$1" -name '*.glb' -not -path '*/.*' | wc -l)
  [ "$glbs" = "$3" ] || wrong "$glbs results instead of $3 in $1"
}
