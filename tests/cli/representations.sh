# What of the sources is blended, and how it is told: bash representations.sh PROGRAM SCRATCH SHAPES
. "$(dirname "$0")/testing.sh"
shapes=$3

recipe() { # NAME, first source, second source, fields of the recipe as JSON
  jq -n --arg a "$shapes/$2" --arg b "$shapes/$3" --argjson more "${4-"{}"}" '{version: 1, name: "way",
    sources: {a: $a, b: $b}, timeline: {fps: 4, keys: [{time: 0, state: "a"}, {time: 1, state: "b"}]}} * $more' >"$1.json"
}
solve_of() { jq -r ".solve.$2" "$1/report.json"; }
bake() { run 0 bake "$1.json" -o "$1" --report "$1/report.json"; }

# Bent and twisted bars are turned along by themselves; two creatures of one stance are not.
recipe bars bar_straight.glb bar_bent_twisted.glb
bake bars
[ "$(solve_of bars representation)" = rotation ] || wrong "bars: $(solve_of bars representation), $(solve_of bars representation_reason)"
[ "$(solve_of bars solver)" = warm ] || wrong "frames are solved by $(solve_of bars solver)"
stderr_has '  rotation: half-way from "a" to "b" edges lose '
run 0 bake bars.json -o little --memory-limit 0 --report little/report.json
[ "$(solve_of little representation) $(solve_of little solver)" = "rotation pcg" ] || wrong "little memory: $(jq -c .solve little/report.json)"
recipe creatures creature_base.glb creature_stout.glb
bake creatures
[ "$(solve_of creatures representation)" = laplacian ] || wrong "creatures: $(solve_of creatures representation), $(solve_of creatures representation_reason)"
stderr_has '  laplacian: half-way from "a" to "b" edges lose '
# What only differences give decides before that.
recipe tracks bar_straight.glb bar_bent_twisted.glb '{"outputs": [{"file": "way.glb", "targets": "tracks"}]}'
bake tracks
[ "$(solve_of tracks representation_reason)" = 'an output asks for tracks, though half-way from "a" to "b" edges lose 51 % of their length by their turns' ] || wrong "tracks: $(solve_of tracks representation_reason)"
jq '.representation = "rotation"' tracks.json >asked.json
run 2 validate asked.json
stderr_has '#/outputs/0/targets: error: "tracks" targets are shapes that are solved once; the representation "rotation" solves every frame'

# A shape that is fitted to its ring is measured, too.
jq '.regions = {low: {ball: {on: "a", at: "bottom", inner: 0.25, outer: 0.5}}, high: {invert: "low"}} |
  .timeline = {fps: 4, tracks: [{name: "t", region: "high", to: "b", fit: "similarity", begin: 0, end: 1}]}' bars.json >fitted.json
bake fitted
[ "$(solve_of fitted representation)" = rotation ] || wrong "fitted: $(solve_of fitted representation_reason)"
stderr_has 'half-way from "a" to "b fitted" edges lose '

# Where rotations turn sharply, `auto` leaves them, and who asks for them is told where.
jq -n --arg a "$shapes/face.glb" '{version: 1, name: "way",
  sources: {a: $a, b: {edit: {of: "a", region: "nose", handles: [{region: "tip", rotate: {axis: [0, 0, 1], degrees: 170}}]}}},
  regions: {nose: {ball: {on: "a", at: "nose_tip", inner: 0.3, outer: 0.4}}, tip: {ball: {on: "a", at: "nose_tip", inner: 0.2, outer: 0.2}}},
  representation: "rotation", timeline: {fps: 4, keys: [{time: 0, state: "a"}, {time: 1, state: "b"}]}}' >sharp.json
bake sharp
stderr_has 'sharp.json#/representation: warning: from "a" to "b"'
stderr_has '[solve.sharp-turns]'
jq '.representation = "auto"' sharp.json >unclear.json
bake unclear
[ "$(solve_of unclear representation)" = laplacian ] || wrong "unclear: $(solve_of unclear representation)"

# All of them end in their sources.
for representation in laplacian rotation affine absolute rigid; do
  recipe $representation bar_straight.glb bar_bent_twisted.glb \
    "{\"representation\": \"$representation\", \"outputs\": [{\"file\": \"way.glb\"}, {\"file\": \"end.glb\", \"still\": {\"at\": 1}}, {\"file\": \"half.glb\", \"still\": {\"at\": 0.5}}]}"
  bake $representation
  [ "$(solve_of $representation representation)" = $representation ] || wrong "$representation became $(solve_of $representation representation)"
  cmp -s laplacian/end.glb $representation/end.glb || wrong "$representation does not end in its source"
done
cmp -s laplacian/half.glb rotation/half.glb && wrong "rotations change nothing"
recipe again bar_straight.glb bar_bent_twisted.glb "$(jq '{representation, outputs}' rotation.json)"
run 0 bake again.json -o again --threads 1
cmp -s rotation/way.glb again/way.glb || wrong "rotations differ with one thread"
finish
