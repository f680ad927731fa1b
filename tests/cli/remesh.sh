# Sources on one new connectivity: bash remesh.sh PROGRAM SCRATCH RECIPE SHAPES
. "$(dirname "$0")/testing.sh"
recipe=$3
shapes=$4

run 0 remesh "$recipe" -o k --report k/report.json
for file in face.glb long.glb face.maps.bin face.connectivity.png report.json; do
  [ -s "k/$file" ] || wrong "wrote no $file"
  stdout_has "k/$file"
done
[ "$(find k -type f | wc -l)" = 5 ] || wrong "wrote $(find k -type f)"
jq -e '.connectivity | .mode == "resample" and .vertices > 500 and (.steps | length) > 3 and (.distortion | length) == 1
  and all(.sources[]; .folds == 0 and .new_self_intersections == 0 and .landmark_error < 1e-12 and .smallest_angle > 5)' \
  k/report.json >/dev/null || wrong "odd report: $(jq -c .connectivity k/report.json)"

# The same bytes again, on one thread; without the sheet nothing else changes.
run 0 remesh "$recipe" -o again --threads 1
for file in face.glb long.glb face.maps.bin face.connectivity.png; do
  cmp -s "k/$file" "again/$file" || wrong "two runs differ in $file"
done
run 0 remesh "$recipe" -o bare --sheet none
[ -e bare/face.connectivity.png ] && wrong "--sheet none makes a sheet"

# A bake that remeshes itself, and one that starts from the files, give the same bytes.
run 0 bake "$recipe" -o baked --report baked/report.json
jq -e '.connectivity.mode == "resample" and .vertices == .connectivity.vertices' baked/report.json >/dev/null ||
  wrong "odd report: $(jq -c .connectivity baked/report.json)"
jq --arg landmarks "$shapes/face.landmarks.json" \
  '.connectivity = {mode: "shared"} | .sources = {face: {file: "k/face.glb", landmarks: $landmarks}, long: "k/long.glb"}' \
  "$recipe" >shared.json
run 0 bake shared.json -o from_files
cmp -s baked/face.glb from_files/face.glb || wrong "the bake from the files differs"
run 0 validate "$recipe"

# What cannot be is told before any work, and leaves nothing.
run 2 remesh shared.json -o none
stderr_has '#/connectivity/mode: error: the mode "shared" makes no new triangles [recipe.bad-value]'
jq --arg shapes "$shapes" '.sources = {face: "k/face.glb", long: "k/long.glb"} | del(.regions) |
  .timeline.tracks[0] |= del(.region)' "$recipe" >over.json
cp k/face.glb before.glb
run 2 remesh over.json -o k
stderr_has "k/face.glb would replace a source [recipe.overwrites-source]"
cmp -s k/face.glb before.glb || wrong "a source was replaced"
jq --arg shapes "$shapes" '.sources = {face: ($shapes + "/face.glb"), long: ($shapes + "/face_long_nose.glb")} |
  .connectivity = {mode: "resample", target_edge_length: 0.001}' "$recipe" >large.json
run 4 remesh large.json -o none
stderr_has "[connectivity.too-many-vertices]"
stderr_has "hint: a target_edge_length of "
jq --arg shapes "$shapes" '.sources = {face: ($shapes + "/face.glb"), long: ($shapes + "/egg.glb")} | del(.connectivity)' \
  "$recipe" >different.json
run 4 bake different.json -o none
stderr_has '"connectivity": {"mode": "remesh"}'
[ "$(ls none)" = face.mismatch.png ] || wrong "not the picture of the mismatch alone: $(ls none)"
finish
