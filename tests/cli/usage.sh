# Wrong command lines: exit code 2, a reason and a hint on stderr, nothing on stdout, no file.
# bash usage.sh PROGRAM SCRATCH
. "$(dirname "$0")/testing.sh"

refused() { # TEXT ARGUMENTS...
  local text=$1
  shift
  run 2 "$@"
  stderr_has "$text"
  [ -s "$scratch/stdout" ] && wrong "prints on stdout: morphbake $*"
  run 2 "$@" --log json
  stderr_is_json_lines
}

refused "no command given"
refused "'bakee' is no command" bakee recipe.json
refused "RECIPE is required" bake
refused "--colour" bake recipe.json --colour
refused "second.json" bake recipe.json second.json
refused "second.json" bake recipe.json --set /basis/easing_tolerance=1 second.json
refused "--threads" bake recipe.json --threads -1
refused "--preview" bake recipe.json --preview some
refused "SOURCES" init one.glb
refused "'5' is not a size" preview a.glb --size 5
refused "'1x100' is not a size" preview a.glb --size 1x100
refused "mp4" preview a.glb --formats mp4
refused "second.glb" preview a.glb second.glb
refused "name two to six files" preview --compare a.glb
refused "name two to six files" preview --compare 1.glb 2.glb 3.glb 4.glb 5.glb 6.glb 7.glb
refused "--compare" preview a.glb --json
refused "none.glb" preview --compare none.glb missing.glb
refused "[files.missing]" inspect none.glb
refused "add --weights FILE.png" inspect none.glb --animation wave
refused "FILE is required" lint
refused "--profile is required" lint none.glb
refused "[files.missing]" lint none.glb --profile web-three
refused "[files.missing]" lint none.glb --profile none.json
refused 'did you mean "web-three"?' lint none.glb --profile web-tree
refused "none.json" bake none.json
refused "none.json" validate none.json
run 2 --log loud config
stderr_has "loud"

echo '{}' >recipe.json
run 2 init a.glb b.glb
stderr_has "[usage.would-overwrite]"
[ "$(cat recipe.json)" = '{}' ] || wrong "init overwrote a file"
rm recipe.json
no_file_in .

run 0 config
jq -e . "$scratch/stdout" >/dev/null || wrong "config does not print JSON"
if [ -e /dev/full ]; then
  "$program" config >/dev/full 2>"$scratch/stderr"
  [ $? = 6 ] || wrong "a full stdout is not noticed"
fi
LC_ALL=de_DE.UTF-8 "$program" config | cmp -s - "$scratch/stdout" || wrong "config depends on the locale"
finish
