# What `lint` says and returns, and what `inspect` tells of targets. bash lint.sh PROGRAM SCRATCH RECIPE
. "$(dirname "$0")/testing.sh"
cp "$(dirname "$3")"/{flat,tall}.gltf .
jq '.outputs = [{file: "tetrahedra.glb"}]' "$3" >recipe.json
run 0 bake recipe.json --preview none -o out
file=out/tetrahedra.glb

run 0 lint --list
stdout_has "spec-min"
stdout_has "unequal-attributes"
for profile in $("$program" lint --list | awk 'NF == 0 { exit } NR > 1 { print $1 }'); do
  run 0 lint $file --profile "$profile"
  stdout_has "0 errors, 0 warnings"
  run 0 lint $file --profile "$profile" --strict
done
[ -s "$scratch/stderr" ] && wrong "lint prints on stderr: $(cat "$scratch/stderr")"

# Findings: 1 with errors, 0 with warnings, unless those are to count.
echo '{"title": "Few", "most_targets": 1, "forbidden_in_names": "aeiou"}' >few.json
run 1 lint $file --profile few.json
stdout_has "[name-characters]"
run 1 lint $file --profile few.json --json
jq -e '.profile == "few" and .errors > 0 and .findings[0].pointer != "" and .meshes[0].gpu[0].bytes > 0' \
  "$scratch/stdout" >/dev/null || wrong "odd report: $(cat "$scratch/stdout")"
run 1 lint $file --profile web-three --loop
stdout_has "[loop]"
run 0 lint $file --profile web-three
stdout_has "[open-loop]"
run 0 lint $file --profile web-three --no-notes
grep -q "open-loop" "$scratch/stdout" && wrong "--no-notes shows a note"

# Whatever keeps it from judging is 2, and all that is wrong with a profile is told at once.
echo '{"titel": "x", "most_targets": "many"}' >odd.json
run 2 lint $file --profile odd.json
stderr_has "odd.json#/most_targets: error: most_targets must be a whole number from 1 to 65535, not \"many\""
stderr_has 'did you mean "title"?'
run 2 lint $file --profile web-three --node Nobody
stderr_has "[gltf.no-such-node]"
head -c 100 $file >cut.glb
run 2 lint cut.glb --profile web-three
stderr_has "[gltf.truncated]"
run 2 lint few.json --profile web-three --log json
stderr_is_json_lines

# What a file says cannot act on the terminal.
jq '.nodes[0].name = "\u001b[31mred"' flat.gltf >red.gltf
run 0 lint red.gltf --profile web-three
grep -q $'\033' "$scratch/stdout" && wrong "a control character reaches the terminal"
stdout_has '\u001b[31mred'

run 0 inspect $file --json
jq -e '(.targets | all(.bytes > 0)) and .target_bytes > 0 and (.gpu | length) > 3 and .gpu_bytes > 0 and .weights == null' \
  "$scratch/stdout" >/dev/null || wrong "odd facts: $(cat "$scratch/stdout")"
run 0 inspect $file --weights w/weights.png --json
jq -e '.weights.picture == "w/weights.png" and (.weights.times | length) == (.weights.values[0] | length)' \
  "$scratch/stdout" >/dev/null || wrong "odd weights: $(cat "$scratch/stdout")"
[ "$(head -c 4 w/weights.png | tail -c 3)" = PNG ] || wrong "no picture of the weights"
cp w/weights.png first.png
run 0 inspect $file --weights w/weights.png --animation 0
cmp -s w/weights.png first.png || wrong "two pictures differ"
run 4 inspect $file --weights none.png --animation Nothing
run 4 inspect red.gltf --weights none.png
stderr_has "[gltf.no-such-animation]"
run 6 inspect $file --weights /proc/none.png
no_file_in none.png
finish
