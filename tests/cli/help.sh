# Every command explains itself: on stdout, with an example. bash help.sh PROGRAM SCRATCH
. "$(dirname "$0")/testing.sh"

run 0 --help
stdout_has "Exit codes: 0 done"
[ -s "$scratch/stderr" ] && wrong "--help prints on stderr"
for command in init bake batch validate inspect lint preview diff golden landmarks config; do
  run 0 --help
  stdout_has "  $command "
  run 0 $command --help
  stdout_has "Example: morphbake $command"
  [ -s "$scratch/stderr" ] && wrong "$command --help prints on stderr"
done
run 0 --version
grep -qE '^morphbake [0-9]+\.[0-9]+\.[0-9]+$' "$scratch/stdout" || wrong "odd version: $(cat "$scratch/stdout")"
no_file_in .
finish
