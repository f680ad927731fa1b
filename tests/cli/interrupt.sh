# Ctrl-C and SIGTERM during a bake: exit code 130, and nothing is left. bash interrupt.sh PROGRAM SCRATCH RECIPE
. "$(dirname "$0")/testing.sh"

for signal in INT TERM; do
  # The recipe's thousand pictures take minutes: the signal comes while one is rendered.
  "$program" bake "$3" --output-dir "$scratch/out" --report "$scratch/out/report.json" \
    >"$scratch/stdout" 2>"$scratch/stderr" </dev/null &
  bake=$!
  for _ in $(seq 600); do
    grep -q '^preview' "$scratch/stderr" && break
    sleep 0.1
  done
  grep -q '^preview' "$scratch/stderr" || wrong "the bake never came to its previews"
  kill -$signal $bake
  started=$(date +%s)
  wait $bake
  code=$?
  [ $code = 130 ] || wrong "exit code $code after SIG$signal"
  [ $(($(date +%s) - started)) -lt 20 ] || wrong "took more than 20 s to stop"
  [ -s "$scratch/stdout" ] && wrong "names files on stdout"
  stderr_has "interrupted"
  no_file_in "$scratch/out" .
done
finish
