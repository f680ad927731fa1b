# Kinds of targets, bounds, profiles and encodings of outputs: bash output_targets.sh PROGRAM SCRATCH SHAPES
. "$(dirname "$0")/testing.sh"
shapes=$3

recipe() { # NAME, fields of the output as JSON, then of the recipe
  jq -n --arg shapes "$shapes" --argjson output "$2" --argjson more "${3-{\}}" '{version: 1, name: "sweep", hold: "none",
    sources: {face: ($shapes + "/face.glb"), other: ($shapes + "/face_long_nose.glb")},
    regions: {moving: {spatial: {half_space: {normal: [0, 1, 0],
      offset: {keys: [{time: 0, value: -1.2}, {time: 2, value: 1.2}]}}, width: 0.5}}},
    timeline: {fps: 20, tracks: [{name: "nose", region: "moving", to: "other", begin: 0, end: 2, ease: "linear"}]},
    outputs: [{file: "sweep.glb"} + $output]} + $more' >"$1.json"
}
report() { jq -r ".outputs[0]$1" out/report.json; }
bake() { run "$1" bake "$2.json" --preview none -o out --report out/report.json; }

# `auto` takes what has fewest targets, and what is told is what is written.
for targets in auto keyframes basis frames; do
  recipe kind "{\"targets\": \"$targets\"}"
  bake 0 kind
  echo "$targets: $(report .kind), $(report '.targets | length') targets, $(report .max_error)"
  case $targets in
    auto) least=$(report '.targets | length') ;;
    *) [ "$(report .kind)" = $targets ] || wrong "$targets became $(report .kind)"
       [ "$least" -le "$(report '.targets | length')" ] || wrong "auto has more targets than $targets" ;;
  esac
  jq -e '.outputs[0] | .max_error <= 0.001 and .worst.time >= 0 and .worst.time <= 2' out/report.json >/dev/null ||
    wrong "odd report: $(jq -c .outputs[0] out/report.json)"
done

# A smaller bound needs more; one that float32 cannot keep is an error, and nothing is written.
recipe fine '{"targets": "keyframes", "max_error": 0.00001}'
bake 0 fine
[ "$(report '.targets | length')" -gt "$least" ] || wrong "a smaller bound needs no more targets"
rm -rf out
recipe finest '{"targets": "frames", "max_error": 1e-9}'
bake 2 finest
stderr_has "#/outputs/0/max_error"

# The node that has the name may have the mesh on another below it, for the scale of its integers.
recipe plain '{"encoding": "float"}'
bake 0 plain
run 0 inspect out/sweep.glb --json
moved=$(jq .largest_displacement "$scratch/stdout")
recipe scaled '{"encoding": "quantized"}'
bake 0 scaled
run 0 inspect out/sweep.glb --json
jq -e --argjson moved "$moved" '(.largest_displacement / $moved - 1) | fabs < 0.01' "$scratch/stdout" >/dev/null ||
  wrong "integers move by $(jq .largest_displacement "$scratch/stdout"), floats by $moved"
named=$(node -e 'const b = require("fs").readFileSync("out/sweep.glb"); const j = JSON.parse(b.subarray(20, 20 + b.readUInt32LE(12)));
  const i = j.nodes.findIndex((each) => each.children?.some((child) => j.nodes[child].mesh !== undefined)); console.log(i < 0 ? "" : j.nodes[i].name ?? i)')
[ -n "$named" ] || wrong "the mesh of integers hangs on no node of its own"
run 0 inspect out/sweep.glb --node "$named"
run 0 lint out/sweep.glb --profile web-three --node "$named"

rm -rf out
recipe integers '{"targets": "frames", "max_error": 0.000001, "encoding": "quantized"}'
bake 5 integers
stderr_has "[export.position-error]"
stderr_has '"encoding": "sparse" writes floats'
no_file_in out

# A profile: more targets than its client reads are an error with what would fit, which does.
recipe few '{"targets": "frames", "profile": "spec-min"}'
bake 5 few
stderr_has "#/outputs/0/profile: error"
stderr_has "[export.breaks-profile]"
no_file_in out
fits=$(sed -n 's/.*"targets": "\([a-z]*\)" with "max_error": \([0-9.e-]*\) needs \([0-9]*\).*/\1 \2 \3/p' "$scratch/stderr" | head -1)
read -r kind error count <<<"$fits"
[ -n "${count-}" ] || wrong "no option is told: $(cat "$scratch/stderr")"
recipe fitting "{\"targets\": \"$kind\", \"max_error\": $error, \"profile\": \"spec-min\"}"
bake 0 fitting
[ "$(report '.targets | length')" = "$count" ] || wrong "$fits, but $(report '.targets | length') targets"
run 0 lint out/sweep.glb --profile spec-min

# A profile chooses the encoding; another one that it does not read is an error.
recipe three '{"profile": "web-three"}'
bake 0 three
run 0 inspect out/sweep.glb --json
head -c 4000 out/sweep.glb | grep -aq KHR_mesh_quantization || wrong "web-three is not quantized"
recipe wrong '{"profile": "bevy", "encoding": "quantized"}'
bake 2 wrong
stderr_has "#/outputs/0/encoding: error"
stderr_has "[recipe.breaks-profile]"
recipe unknown '{"profile": "web-thre"}'
bake 2 unknown
stderr_has "#/outputs/0/profile: error"
stderr_has "web-three"
echo '{"title": "Mine", "most_targets": 100, "mesh_quantization": true, "encoding": "float"}' >mine.json
recipe own '{"profile": "mine.json"}'
bake 0 own
head -c 4000 out/sweep.glb | grep -aq KHR_mesh_quantization && wrong "an own profile's encoding is not taken"
echo '{"title": "Mine", "most_targetz": 100}' >mine.json
bake 2 own
stderr_has "mine.json"
stderr_has "most_targets"

recipe long '{"targets": "basis"}' '{"timeline": {"fps": 120, "tracks": [{"region": "moving", "to": "other", "begin": 0, "end": 20}]}}'
run 2 validate long.json
stderr_has "#/outputs/0/targets: error"
stderr_has "2000 frames at most"
finish
