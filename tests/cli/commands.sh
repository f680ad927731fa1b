# What each command prints when all is right. bash commands.sh PROGRAM SCRATCH RECIPE
. "$(dirname "$0")/testing.sh"
folder=$(dirname "$3")

run 0 validate "$3"
stdout_has "valid (2 sources"
no_file_in .

run 0 bake "$3" --preview none -o out --report out/report.json
while IFS= read -r file; do
  [ -s "$file" ] || wrong "names a file that is not there: $file"
done <"$scratch/stdout"
[ "$(wc -l <"$scratch/stdout")" = "$(find out -type f | wc -l)" ] || wrong "stdout does not name every file"
stderr_has "4 vertices"
jq -e '.outputs | length == 1' out/report.json >/dev/null || wrong "odd report"
run 0 --version
[ "morphbake $(jq -r .morphbake out/report.json)" = "$(cat "$scratch/stdout")" ] || wrong "the report is of another version"
# The commit changes no byte of what is baked.
grep -aqE '"generator":"morphbake [0-9]+\.[0-9]+\.[0-9]+"' out/tetrahedra.glb || wrong "the file does not tell the plain version"

run 0 bake "$3" --preview none -o quiet --quiet
[ -s "$scratch/stderr" ] && wrong "--quiet prints on stderr"
cmp -s out/tetrahedra.glb quiet/tetrahedra.glb || wrong "two bakes differ"
run 0 bake "$3" --preview none -o json --log json
stderr_is_json_lines
jq -es 'any(.[]; .report.outputs | length == 1)' "$scratch/stderr" >/dev/null || wrong "no report in the JSON lines"

grep -aq '"extras":{"extras":"of another kind than an object","targetNames":\[' out/tetrahedra.glb ||
  wrong "the mesh's extras are lost"

run 0 inspect out/tetrahedra.glb
stdout_has "4 vertices"
run 0 inspect out/tetrahedra.glb --json
jq -e '.largest_displacement > 0.9 and .animations[0].duration == 1 and (.targets | length) > 0 and .gpu_bytes > 0' \
  "$scratch/stdout" >/dev/null || wrong "odd facts: $(cat "$scratch/stdout")"

run 0 preview out/tetrahedra.glb -o turn/stem --size 32x16 --frames 2 --formats gif,sheet
stdout_has "turn/stem.gif"
stdout_has "turn/stem.sheet.png"
[ "$(find turn -type f | wc -l)" = 2 ] || wrong "preview wrote $(find turn -type f)"

run 0 init "$folder/flat.gltf" "$folder/tall.gltf" -o first.json
stdout_has "first.json"
[ -f "$(jq -r '."$schema"' first.json)" ] || wrong "init names no schema: $(jq -c '."$schema"' first.json)"
run 0 bake first.json --preview none -o first
run 2 init "$folder/flat.gltf" "$folder/tall.gltf" -o first.json
run 0 init "$folder/flat.gltf" "$folder/tall.gltf" -o first.json --force
finish
