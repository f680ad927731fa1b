# Places that cannot be written: exit code 6, the place is named, nothing is left elsewhere.
# bash unwritable.sh PROGRAM SCRATCH RECIPE
. "$(dirname "$0")/testing.sh"

echo "a file" >"$scratch/file"
run 6 bake "$3" --preview none --output-dir "$scratch/file/out"
stderr_has "[output.unwritable]"
stderr_has "$scratch/file"
run 6 bake "$3" --preview none --output-dir /proc/none
stderr_has "/proc/none"
run 6 bake "$3" --preview none --output-dir "$scratch/out" --report "$scratch/file/report.json"
stderr_has "$scratch/file"
no_file_in "$scratch/out"
[ "$(cat "$scratch/file")" = "a file" ] || wrong "a file was replaced"
no_file_in .
finish
