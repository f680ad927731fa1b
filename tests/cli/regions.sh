# Regions and derived sources on real files, and what is wrong with them: bash regions.sh PROGRAM SCRATCH SHAPES
. "$(dirname "$0")/testing.sh"
shapes=$3

recipe() { # NAME, region "r" as JSON, fields of the recipe as JSON
  jq -n --arg shapes "$shapes" --argjson region "$2" --argjson more "${3-"{}"}" '{version: 1, name: "regions",
    sources: {base: ($shapes + "/creature_base.glb"), stout: ($shapes + "/creature_stout.glb")},
    regions: {r: $region, nose: {ball: {on: "base", at: "nose", inner: 0.1, outer: 0.2}}},
    timeline: {fps: 4, tracks: [{name: "t", region: "r", to: "stout", begin: 0, end: 1}]}} * $more' >"$1.json"
}
targets_of() { "$program" inspect "$1" --json | jq -r '.targets | length'; }

# A region that moves makes every frame another: as few targets as keep the bound, unless tracks are asked for.
recipe sweep '{"spatial": {"half_space": {"normal": [0, 0, 1], "offset": {"keys": [{"time": 0, "value": -0.6}, {"time": 1, "value": 0.6}]}}, "width": 0.2}}' \
  '{"timeline": {"tracks": [{"name": "t", "region": "r", "to": "stout", "begin": 0, "duration": 0}], "duration": 1}}'
run 0 bake sweep.json -o sweep --report sweep/report.json
[[ "$(targets_of sweep/regions.glb)" == [1-4] ]] || wrong "a sweep of 4 frames has $(targets_of sweep/regions.glb) targets"
run 0 bake sweep.json -o again --threads 1
cmp -s sweep/regions.glb again/regions.glb || wrong "a sweep differs with one thread"
jq '.outputs = [{file: "x.glb", targets: "tracks"}]' sweep.json >tracks.json
run 2 validate tracks.json
stderr_has "#/outputs/0/targets: error: \"tracks\" targets are shapes that are solved once; here a region moves or floods"
jq '.hold = ["r"]' sweep.json >held.json
run 2 validate held.json
stderr_has "#/hold/0: error: the region r changes with time [recipe.moving-region]"
# At its end the plane has passed everything: the file shows the other source there.
jq '.outputs = [{file: "end.glb", still: {at: 1}}, {file: "stout.glb", still: {at: "stout"}}]' sweep.json >stills.json
run 0 bake stills.json -o stills
cmp -s stills/end.glb stills/stout.glb || wrong "the sweep does not end in its target"

# A flood takes all in the end, and nothing before it begins.
recipe flood '{"flood": {"on": "base", "from": ["nose"], "distance": "hops", "softness": 0}}' \
  '{"outputs": [{"file": "end.glb", "still": {"at": 1}}, {"file": "stout.glb", "still": {"at": "stout"}}, {"file": "flood.glb"}]}'
run 0 bake flood.json -o flood
cmp -s flood/end.glb flood/stout.glb || wrong "the flood does not end in its target"
[[ "$(targets_of flood/flood.glb)" == [1-4] ]] || wrong "a flood of 4 frames has $(targets_of flood/flood.glb) targets"

# What is wrong is told with its place.
refused() { # CODE, TEXT: what validate says of the last recipe
  run "$1" validate "$name.json"
  stderr_has "$2"
}
name=bad
recipe bad '{"spatial": {"expression": "x + * y"}}'
refused 2 '#/regions/r/spatial/expression: error: "x + * y" cannot be read'
recipe bad '{"spatial": {"expression": "1 / (x - x)"}}'
refused 2 '#/regions/r/spatial/expression: error: "1 / (x - x)" is'
recipe bad '{"spatial": {"expression": "sqrt(x) - w"}}'
refused 2 'w'
for assignment in 'x = 5' 'y=x' '(x=0)+y'; do
  recipe bad "{\"spatial\": {\"expression\": \"$assignment\"}}"
  refused 2 '= would change a variable; == compares'
done
recipe bad '{"spatial": {"expression": "x == 0 ? -1 : x >= 1"}}'
run 0 validate bad.json
recipe bad '{"spatial": {"expression": "x\u0000 garbage((("}}'
refused 2 'cannot be read: it has a zero character in it'
# Combinations of combinations are evaluated once each, not once for each way to them.
jq '.regions += ([range(40)] | map({key: "u\(.)", value: {union: (if . == 0 then ["r", "nose"] else ["u\(. - 1)", "u\(. - 1)"] end)}}) | from_entries)
  | .timeline.tracks[0].region = "u39"' sweep.json >nested.json
run 0 validate nested.json
# Each included file's names start at its own folder.
mkdir -p a b
cp "$shapes"/creature_base.* a/
cp "$shapes"/creature_stout.* b/
echo '{"version": 1, "sources": {"base": "creature_base.glb"}}' >a/part.json
echo '{"version": 1, "sources": {"stout": "creature_stout.glb"}}' >b/part.json
jq 'del(.sources) | .include = ["a/part.json", "b/part.json"]' sweep.json >parts.json
run 0 validate parts.json
# A file that two included ones include counts once.
jq 'del(.sources, .timeline) | {version, regions}' sweep.json >common.json
echo '{"version": 1, "include": ["../common.json"], "sources": {"base": "creature_base.glb"}}' >a/part.json
echo '{"version": 1, "include": ["../common.json"], "sources": {"stout": "creature_stout.glb"}}' >b/part.json
jq 'del(.sources, .regions) | .include = ["a/part.json", "common.json", "b/part.json"]' sweep.json >diamond.json
run 0 validate diamond.json
# More tracks than shapes can be: solved as frames, and as tracks refused.
jq '.timeline.tracks = [range(300) | {name: "t\(.)", region: "nose", to: "stout", begin: (. / 300), end: ((. + 1) / 300)}]' sweep.json >many.json
run 0 bake many.json -o many
stderr_has "[transition.too-many-overlaps]"
[[ "$(targets_of many/regions.glb)" == [1-4] ]] || wrong "300 tracks over 4 frames have $(targets_of many/regions.glb) targets"
jq '.outputs = [{file: "x.glb", targets: "tracks"}]' many.json >many_tracks.json
run 2 validate many_tracks.json
stderr_has '#/outputs/0/targets: error: "tracks" targets are shapes that are solved once; more than 255 are needed here'
# A spatial region on shapes that are all derived lies in the coordinates of their file.
recipe far '{"spatial": {"half_space": {"normal": [0, 0, 1]}}}' \
  '{"sources": {"high": {"transform": {"of": "stout", "scale": 2}}}, "timeline": {"start": "high", "tracks": [{"name": "t", "region": "r", "to": "high", "begin": 0, "end": 1}]}, "preview": {"maps": ["regions"]}}'
jq '.regions.r.spatial.on = ["stout"]' far.json >near.json
run 0 bake far.json -o far
run 0 bake near.json -o near
cmp -s far/regions.regions.png near/regions.regions.png || wrong "a derived shape has other coordinates than its file"
# What goes wrong later has its place as well.
recipe bad '{"spatial": {"expression": "1 / (t - 1)"}}'
refused 2 '#/regions/r/spatial/expression: error: "1 / (t - 1)" is'
recipe bad '{"ball": {"on": "base", "at": {"position": [9, 9, 9]}, "inner": 0.1, "outer": 0.2}}'
refused 2 '#/regions/r/ball/at: error: (9, 9, 9) is'
stderr_has '[landmarks.off-surface]'
recipe bad '{"ball": {"on": "low", "at": "nose", "inner": 0.1, "outer": 0.2}}' '{"sources": {"low": {"band": {"of": "base", "last": 20}}}}'
refused 2 '#/regions/r/ball/on: error: "low" is made from another source'
echo 'no picture' >grey.png
recipe bad '{"mask": {"on": "base", "image": "grey.png"}}'
refused 2 '#/regions/r/mask/image: error:'
recipe bad '{"rings": {"on": "base", "inner": ["nose", "ear_left", "ear_right"], "outer": ["nose", "ear_left", "ear_right"]}}'
refused 2 '#/regions/r/rings/outer: error: the outer loop is no ring: it meets the inner loop at'
recipe bad '{"mask": {"on": "base", "attribute": "_MASK"}}'
refused 2 '#/regions/r/mask/attribute: error: the mesh of "base" has no attribute "_MASK" [recipe.mask]'
recipe bad '{"mask": {"on": "base", "attribute": "POSITION", "channel": 3}}'
refused 2 '#/regions/r/mask/channel: error: POSITION has no channel 3: it has 3 numbers a vertex [recipe.mask]'
recipe bad '{"mask": {"on": "base", "primitive": 7}}'
refused 2 '#/regions/r/mask/primitive: error: the mesh of "base" has no primitive 7: it has 1 [recipe.mask]'
recipe bad '{"mask": {"on": "base", "material": "gold"}}'
refused 2 'error: the file of "base" has no material "gold" [recipe.mask]'
recipe bad '{"union": ["nose"]}' '{"sources": {"low": {"band": {"of": "base", "last": 10000000}}}}'
refused 2 '#/sources/low/band/last: error: the band 0 to 10000000 of a mesh with'
handle='{"region": "nose", "translate": [0, 0, 0.1]}'
recipe bad '{"ball": {"on": "base", "at": "nose", "inner": 0.2, "outer": 0.3}}' \
  "{\"sources\": {\"long\": {\"edit\": {\"of\": \"base\", \"region\": \"r\", \"handles\": [$handle, $handle]}}}}"
refused 2 '#/sources/long/edit/handles/1: error:'
stderr_has '[derive.overlapping-handles]'
recipe bad '{"ball": {"on": "base", "at": "nose", "inner": 0.2, "outer": 0.3}}' \
  '{"sources": {"flat": {"mirror": {"of": "base", "normal": [0, 0, 1]}}}}'
refused 2 '[derive.not-symmetric]'
# A normal is a direction, however long: the offset is a length.
for normal in 1 10 1e-200; do
  recipe "mirror$normal" '{"ball": {"on": "base", "at": "nose", "inner": 0.2, "outer": 0.3}}' \
    "{\"sources\": {\"other\": {\"mirror\": {\"of\": \"base\", \"normal\": [$normal, 0, 0], \"offset\": 0.001}}},
      \"outputs\": [{\"file\": \"other.glb\", \"still\": {\"at\": \"other\"}}]}"
  run 0 bake "mirror$normal.json" -o "mirror$normal"
  cmp -s mirror1/other.glb "mirror$normal/other.glb" || wrong "a normal of length $normal mirrors differently"
done

recipe tiny '{"spatial": {"half_space": {"normal": {"keys": [{"time": 0, "value": [1e-200, 0, 0]}, {"time": 1, "value": [0, 1e-200, 0]}]}}}}'
run 0 validate tiny.json
recipe bad '{"spatial": {"half_space": {"normal": {"keys": [{"time": 0, "value": [1, 0, 0]}, {"time": 1, "value": [-2, 0, 0]}]}}}}'
refused 2 '#/regions/r/spatial/half_space/normal/keys/1/value: error: it is opposite to the key before'

# A primitive is a mask; the fox's scarf or hat is one by its material.
recipe whole '{"mask": {"on": "base", "primitive": 0}}' '{"outputs": [{"file": "end.glb", "still": {"at": 1}}, {"file": "stout.glb", "still": {"at": "stout"}}]}'
run 0 bake whole.json -o whole
cmp -s whole/end.glb whole/stout.glb || wrong "the only primitive is not the whole mesh"
# Several animations in one file are listed, and each can be seen.
recipe clips '{"spatial": {"half_space": {"normal": [0, 0, 1]}, "width": 0.2}}' \
  '{"outputs": [{"file": "clips.glb", "clips": {"open": {"begin": 0, "end": 0.75}, "shut": {"begin": 0.75, "end": 1}}}]}'
run 0 bake clips.json -o clips
"$program" inspect clips/clips.glb --json | jq -e '[.animations[] | [.name, .duration]] == [["open", 0.75], ["shut", 0.25]]' >/dev/null ||
  wrong "inspect does not list the clips: $("$program" inspect clips/clips.glb --json | jq -c .animations)"
run 0 inspect clips/clips.glb
stdout_has 'open  '
for clip in open shut 1; do
  run 0 preview clips/clips.glb --animation $clip --size 64x64 --frames 4 --formats sheet -o "clips/$clip"
done
cmp -s clips/shut.sheet.png clips/1.sheet.png || wrong "an animation by name and by number differ"
cmp -s clips/open.sheet.png clips/shut.sheet.png && wrong "two animations look the same"
run 4 preview clips/clips.glb --animation wave
stderr_has 'clips.glb#/animations'
stderr_has '[gltf.no-such-animation]'
finish
