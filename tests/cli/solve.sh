# What is held, where the rest stands, every solver: bash solve.sh PROGRAM SCRATCH SHAPES
. "$(dirname "$0")/testing.sh"
shapes=$3

recipe() { # NAME, fields of the recipe as JSON
  jq -n --arg shapes "$shapes" --argjson more "$2" '{version: 1, name: "nose",
    sources: {face: ($shapes + "/face.glb"), other: ($shapes + "/face_long_nose.glb")},
    regions: {nose: {ball: {on: "face", at: "nose_tip", inner: 0.1, outer: 0.22}}, rest: {rest_of: ["nose"]}},
    timeline: {fps: 4, tracks: [{region: "nose", to: "other", begin: 0, end: 1}]},
    outputs: [{file: "nose.glb", targets: "frames"}]} + $more' >"$1.json"
}

recipe held '{}'
run 0 bake held.json -o held --report held/report.json
jq -e '.solve.solver == "direct" and .solve.held > 1000 and .solve.solves[0].name == "nose"' held/report.json >/dev/null ||
  wrong "odd report: $(jq -c .solve held/report.json)"
# The same frames, one by one: as many records as moving frames.
run 0 bake held.json -o frames --set /solve/every_frame=true --report frames/report.json
jq -e '.solve.solver == "warm" and (.solve.solves | length) == 4 and all(.solve.solves[]; .error < 1e-8)' \
  frames/report.json >/dev/null || wrong "odd report: $(jq -c .solve frames/report.json)"

recipe named '{"hold": ["rest"]}'
run 0 bake named.json -o named
cmp -s named/nose.glb held/nose.glb || wrong "holding the rest by name is not what auto does"
recipe changing '{"hold": ["nose"]}'
run 2 bake changing.json -o out
stderr_has "#/hold/0: error: the region nose is held, but \"nose\" changes vertices inside of it [recipe.held-region-changes]"
run 2 validate changing.json
recipe gauged '{"gauge": {"region": "nose"}}'
run 2 bake gauged.json -o out
stderr_has "#/gauge: error: a gauge is for surfaces that hold nothing [recipe.conflicting-fields]"

recipe free '{"hold": "none"}'
for solver in warm pcg gauss-seidel jacobi; do
  run 0 bake free.json -o $solver --set /solve/solver=$solver --set /solve/tolerance=1e-5 --report $solver/report.json
  jq -e --arg solver $solver '.solve.solver == $solver and .solve.held == 0 and .solve.solves[0].iterations > 0 and
    .solve.solves[0].error <= 1e-5' $solver/report.json >/dev/null || wrong "odd report: $(jq -c .solve $solver/report.json)"
done
run 0 bake free.json -o little --memory-limit 0 --report little/report.json
jq -e '.solve.solver == "pcg" and (.solve.reason | startswith("a factor would take about"))' little/report.json >/dev/null ||
  wrong "odd report: $(jq -c .solve little/report.json)"
run 2 bake free.json -o little --memory-limit much
stderr_has '--memory-limit'
run 2 bake held.json -o out --set /solve/solver=jacobi
stderr_has "[options.cannot-hold]"
run 5 bake free.json -o out --set /solve/solver=gauss-seidel --set /solve/max_iterations=40
stderr_has "gauss-seidel stopped after 40 iterations"
stderr_has "[solve.no-convergence]"
run 0 bake free.json -o vertex --set /solve/right_hand_side=vertex

for gauge in '{"region": "rest"}' '{"landmark": {"on": "face", "at": "chin"}}'; do
  recipe gauge "{\"hold\": \"none\", \"gauge\": $gauge}"
  run 0 bake gauge.json -o gauge
done
recipe anchor '{"hold": "none", "gauge": {"anchor": {"on": "face", "at": "chin"}}}'
run 0 bake anchor.json -o anchor
stderr_has "edge lengths out of its neighbours"
stderr_has "[solve.anchor-spike]"

recipe tracks '{"outputs": [{"file": "nose.glb", "targets": "tracks"}]}'
run 2 bake tracks.json -o out --set /solve/every_frame=true
stderr_has "[recipe.needs-frames]"
recipe strict '{"outputs": [{"file": "nose.glb", "max_normal_error": {"percentile_99": 0.1}}]}'
run 5 bake strict.json -o out
stderr_has "#/outputs/0/max_normal_error: error: normals are up to"
stderr_has "[export.normal-error]"
no_file_in out
recipe lax '{"outputs": [{"file": "nose.glb", "max_normal_error": 0.1, "unmet": "warning"}]}'
run 0 bake lax.json -o lax
stderr_has "[export.normal-error]"

# What a bake reads or writes is not to be replaced by its report; nor is a device.
run 2 bake held.json -o out --report held.json
stderr_has "is a file of the recipe"
run 6 bake held.json -o out --report /dev/null
[ -c /dev/null ] || wrong "/dev/null is gone"
recipe still_standing '{"timeline": {"tracks": [{"to": "face", "begin": 0, "end": 1}]}, "outputs": [{"file": "nose.glb"}]}'
run 0 bake still_standing.json -o standing
stderr_has "[basis.nothing-moves]"
finish
