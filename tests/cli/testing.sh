# What the scripts of this folder share: `. testing.sh`. Arguments of each: PROGRAM SCRATCH [...].
set -u
program=$1
scratch=$2
rm -rf "$scratch"
mkdir -p "$scratch/cwd"
cd "$scratch/cwd" || exit 1
failures=0

wrong() {
  echo "WRONG: $*"
  failures=$((failures + 1))
}

# Runs the program, and checks its exit code: run CODE ARGUMENTS...; leaves $scratch/stdout and stderr.
run() {
  local expected=$1 code
  shift
  "$program" "$@" >"$scratch/stdout" 2>"$scratch/stderr" </dev/null
  code=$?
  [ $code = "$expected" ] || {
    wrong "exit code $code instead of $expected: morphbake $*"
    cat "$scratch/stderr"
  }
}

stderr_has() { grep -qF -e "$1" "$scratch/stderr" || { wrong "stderr lacks: $1"; cat "$scratch/stderr"; }; }
stdout_has() { grep -qF -e "$1" "$scratch/stdout" || { wrong "stdout lacks: $1"; cat "$scratch/stdout"; }; }

# Each line on stderr is one JSON object with a severity; a problem has its six fields.
stderr_is_json_lines() {
  jq -es 'length > 0 and all(.[]; type == "object" and has("severity"))
          and all(.[] | select(.severity != "info"); has("code") and has("file") and has("pointer")
            and has("message") and has("hint"))' "$scratch/stderr" >/dev/null &&
    [ "$(jq -c . "$scratch/stderr" | wc -l)" = "$(wc -l <"$scratch/stderr")" ] || {
    wrong "stderr is not one JSON object a line"
    cat "$scratch/stderr"
  }
}

# No file appeared below these folders; the folders themselves may exist.
no_file_in() {
  local found
  found=$(find "$@" ! -type d 2>/dev/null)
  [ -z "$found" ] || wrong "left behind: $found"
}

finish() {
  [ $failures = 0 ] && echo "all right"
  exit $((failures > 0))
}
