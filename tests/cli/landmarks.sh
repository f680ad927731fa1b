# Proposing and showing landmarks. bash landmarks.sh PROGRAM SCRATCH SHAPES
. "$(dirname "$0")/testing.sh"
shapes=$3

# What is wrong is told, and nothing is written.
run 2 landmarks
run 2 landmarks suggest "$shapes/cow.glb"
run 2 landmarks suggest "$shapes/cow.glb" missing.glb -o out
stderr_has "[files.missing]"
run 2 landmarks suggest missing.glb gone.glb -o out
stderr_has "missing.glb"
stderr_has "gone.glb"
run 2 landmarks suggest "$shapes/cow.glb" "$shapes/cow.glb" -o out
stderr_has "[usage.bad-argument]"
run 2 landmarks suggest "$shapes/cow.glb" "$shapes/pig.glb" --count 2 -o out
run 2 landmarks show "$shapes/cow.glb" --landmarks missing.json -o show.png
stderr_has "[files.missing]"
run 2 landmarks show "$shapes/face.glb" --landmarks "$shapes/cow.landmarks.json" -o show.png
stderr_has "cow.landmarks.json#/landmarks/nose: error:"
stderr_has "is this the landmark file of another mesh, or of another scale?"
stderr_has "[landmarks.off-surface]"
# A landmark file that is wrong: refused FILE'S_TEXT CODE
refused() {
  echo "$1" >broken.json
  run 2 landmarks show "$shapes/face.glb" --landmarks broken.json -o show.png
  stderr_has "[$2]"
}
refused '{"version": 1, "landmarks": {"a": {"vertex": 999999}, "b": {"face": 0}}}' landmarks.missing-field
refused '{"version": 1, "landmarks": {"a": {"vertex": 999999}}}' landmarks.out-of-range
refused '{"version": 1, "landmarks": {"a": {"vertex": 0}, "b": {"vertex": 0}}}' landmarks.same-point
refused '{"version": 1, "landmarks": {"a": {"vertex": 0}, "a": {"vertex": 1}}}' json.duplicate-key
refused '{"version": 1, "landmarks": {' json.syntax
refused "$(jq -nc '{version: 1, landmarks: ([range(1001) | {key: "p\(.)", value: {vertex: .}}] | from_entries)}')" \
  landmarks.bad-value
stderr_has "landmarks must have at most 1000 entries, not 1001"
# One point is told once, however many landmarks are there.
refused "$(jq -nc '{version: 1, landmarks: ([range(9) | {key: "p\(.)", value: {vertex: 0}}] | from_entries)}')" \
  landmarks.same-point
[ "$(grep -c same-point "$scratch/stderr")" = 1 ] || wrong "one point is told several times"
rm broken.json
run 4 landmarks suggest "$shapes/cow.landmarks.json" "$shapes/pig.glb" -o out
stderr_has "[gltf.not-gltf]"
run 2 landmarks suggest "$shapes/cow.glb" "$shapes/pig.glb"  # beside them are files already
stderr_has "[usage.would-overwrite]"
no_file_in .
ln -s /proc forbidden
run 6 landmarks suggest "$shapes/cow.glb" "$shapes/pig.glb" -o forbidden/out
rm forbidden
no_file_in .

run 0 landmarks suggest "$shapes/cow.glb" "$shapes/pig.glb" -o out
for file in out/cow.landmarks.json out/pig.landmarks.json out/cow-pig.landmarks.png; do
  stdout_has "$file"
  [ -s "$file" ] || wrong "there is no $file"
done
[ "$(find out -type f | wc -l)" = 3 ] || wrong "wrote $(find out -type f)"
[ "$(jq -c '.landmarks | keys' out/cow.landmarks.json)" = "$(jq -c '.landmarks | keys' out/pig.landmarks.json)" ] ||
  wrong "the names differ"
jq -e '.version == 1 and (.landmarks | length == 10 and has("tip_2_left") and has("tip_2_right"))' \
  out/cow.landmarks.json >/dev/null || wrong "odd landmarks: $(cat out/cow.landmarks.json)"
[ -f "out/$(jq -r '."$schema"' out/cow.landmarks.json)" ] || wrong "names no schema"
run 2 landmarks suggest "$shapes/cow.glb" "$shapes/pig.glb" -o out
run 0 landmarks suggest "$shapes/cow.glb" "$shapes/pig.glb" -o out --force --threads 1
run 0 landmarks suggest "$shapes/cow.glb" "$shapes/pig.glb" -o again
diff -r out again || wrong "two runs differ"

run 0 landmarks suggest "$shapes/cow.glb" "$shapes/pig.glb" -o many --count 100
stderr_has "[landmarks.fewer]"
stderr_has "$(jq '.landmarks | length' many/cow.landmarks.json) landmarks of the 100 wanted were found"
run 0 landmarks suggest "$shapes/face.glb" "$shapes/pig.glb" -o mixed
stderr_has "warning: \"face\" is open (it has a border) but \"pig\" is closed: they cannot be remeshed together"

run 0 landmarks show "$shapes/cow.glb" --landmarks out/cow.landmarks.json -o show.png
stdout_has "show.png"
[ -s show.png ] || wrong "show wrote no picture"
finish
