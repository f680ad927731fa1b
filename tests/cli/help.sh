# Every command explains itself: on stdout, with an example. bash help.sh PROGRAM SCRATCH
. "$(dirname "$0")/testing.sh"

run 0 --help
stdout_has "Exit codes: 0 done"
[ -s "$scratch/stderr" ] && wrong "--help prints on stderr"
for command in init bake plan batch validate inspect lint preview diff golden landmarks cache config manual; do
  run 0 --help
  stdout_has "  $command "
  run 0 $command --help
  stdout_has "Example: morphbake $command"
  [ -s "$scratch/stderr" ] && wrong "$command --help prints on stderr"
done
run 0 --version
grep -qE '^morphbake [0-9]+\.[0-9]+\.[0-9]+( \([0-9a-f]{9}(-dirty)?\))?$' "$scratch/stdout" || wrong "odd version: $(cat "$scratch/stdout")"

run 0 completion bash
stdout_has "complete -F"
run 2 completion tcsh
stderr_has "tcsh"
run 0 manual
lines=0
while read -r line; do
  stdout_has "$line"
  lines=$((lines + 1))
done < <(for command in bake "landmarks suggest"; do
  "$program" $command --help | grep '^  -' | sed 's/-/\\-/g'
done)
[ $lines -ge 10 ] || wrong "only $lines options were looked up in the manual"
if command -v groff >/dev/null; then
  groff -man -Tutf8 -ww -z "$scratch/stdout" 2>"$scratch/groff" || wrong "no manual page"
  [ -s "$scratch/groff" ] && wrong "groff warns: $(cat "$scratch/groff")"
fi
no_file_in .
finish
