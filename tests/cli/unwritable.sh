# Places that cannot be written: exit code 6, the place is named, nothing is left elsewhere.
# bash unwritable.sh PROGRAM SCRATCH SOURCE_DIR
. "$(dirname "$0")/testing.sh"
recipe=$(ls "$3"/examples/*/recipe.json 2>/dev/null | head -n 1)
[ -n "$recipe" ] || { echo "skipped: no example to bake"; exit 77; }

echo "a file" >"$scratch/file"
run 6 bake "$recipe" --preview none --output-dir "$scratch/file/out"
stderr_has "[output.unwritable]"
stderr_has "$scratch/file"
run 6 bake "$recipe" --preview none --output-dir /proc/none
stderr_has "/proc/none"
run 6 bake "$recipe" --preview none --output-dir "$scratch/out" --report "$scratch/file/report.json"
stderr_has "$scratch/file"
[ "$(cat "$scratch/file")" = "a file" ] || wrong "a file was replaced"
no_file_in .
finish
