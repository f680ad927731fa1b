# Several morphs side by side, and what is measured of them. bash compare.sh PROGRAM SCRATCH SHAPES
. "$(dirname "$0")/testing.sh"
shapes=$3

bar() { # NAME, END, TARGETS, EASE: a straight bar that bends and twists until END
  jq -n --arg shapes "$shapes" --arg name "$1" --argjson seconds "$2" --arg targets "$3" --arg ease "$4" '{version: 1, name: $name, representation: "laplacian",
    sources: {straight: ($shapes + "/bar_straight.glb"), bent: ($shapes + "/bar_bent_twisted.glb")},
    timeline: {fps: 12, tracks: [{name: "bend", to: "bent", begin: 0, end: $seconds, ease: $ease}], duration: $seconds},
    outputs: [{file: ($name + ".glb"), targets: $targets}]}' >"$1.json"
  run 0 bake "$1.json" --preview none -o "$1"
}

bar tracks 1 tracks linear
bar frames 1 frames linear
bar eased 2 tracks smoothstep

small="--size 64x48 --frames 6 --set /turntable/samples=1"
# shellcheck disable=SC2086
compare() { run 0 preview --compare "$@" $small; }
json_has() { jq -e "$1" "$scratch/stdout" >/dev/null || wrong "not so: $1"; }

compare tracks/tracks.glb frames/frames.glb eased/eased.glb -o out/three --formats gif,sheet,png
for text in out/three.gif out/three.sheet.png out/three.frames/0005.png tracks.glb frames.glb eased.glb \
  "volume, % of the first frame" "dihedral angles, rms" "    0.00 s" "    2.00 s"; do
  stdout_has "$text"
done
[ "$(find out -type f | wc -l)" = 8 ] || wrong "wrote $(find out -type f)"
cp "$scratch/stdout" table
# shellcheck disable=SC2086
LC_ALL=de_DE.UTF-8 "$program" preview --compare tracks/tracks.glb frames/frames.glb eased/eased.glb $small -o again/three \
  --formats gif,sheet,png >"$scratch/stdout" 2>"$scratch/stderr" || wrong "cannot compare under another locale"
diff <(sed 's/^again/out/' "$scratch/stdout") table || wrong "the table depends on the locale, or on chance"
diff -r out again || wrong "the pictures depend on the locale, or on chance"

compare tracks/tracks.glb frames/frames.glb eased/eased.glb --json --formats sheet
cp "$scratch/stdout" json
[ -s tracks/tracks.compare.sheet.png ] || wrong "no sheet beside the first file"
json_has '(.times | length) == 49 and .times[0] == 0 and .times[48] == 2 and .pictures == ["tracks/tracks.compare.sheet.png"]'
json_has '[.files[].label] == ["tracks.glb", "frames.glb", "eased.glb"] and all(.files[]; .closed and .edges == 3 * .triangles / 2)'
json_has 'all(.files[]; [.volume, .area, .edge_length_change, .dihedral_angle_change] | all(length == 49))'
# Two representations of one motion, but for the frames between which the second one is straight.
json_has '.files as [$a, $b] | [range(49)] | all(. as $i | ($a.area[$i] / $b.area[$i] - 1 | fabs) < 0.01)'
json_has '.files as [$a, $b] | $a.worst.area.deviation != 0 and ($a.worst.area.time - $b.worst.area.time | fabs) < 0.1'
# Positions that are blended in a straight line make a twisted bar thin half-way.
json_has '.files[0] | .volume[12] < 0.99 * ([.volume[0], .volume[24]] | min) and .worst.volume.deviation < -0.01'
# It stays at its end, where it is what is expected.
json_has '.files[0] | .end == 1 and .volume[24] == .volume[48] and (.edge_length_change[30:] | all(. < 1e-6))'
# The way is the same, the times are not.
json_has '.files as [$a, $b, $c] | ($a.volume[0] / $c.volume[0] - 1 | fabs) < 1e-6 and ($a.volume[48] / $c.volume[48] - 1 | fabs) < 1e-6
          and ($a.volume[12] / $c.volume[24] - 1 | fabs) < 1e-3 and $c.edge_length_change[12] < 0.9 * $a.edge_length_change[6]'

# Files of one name are told apart by their folders, open surfaces as what they are.
mkdir other
cp eased/eased.glb other/tracks.glb
compare tracks/tracks.glb other/tracks.glb --formats sheet -o named/named
stdout_has "other/tracks.glb"
jq -n --arg shapes "$shapes" '{version: 1, name: "nose",
  sources: {face: ($shapes + "/face.glb"), other: ($shapes + "/face_long_nose.glb")},
  timeline: {tracks: [{to: "other", begin: 0, end: 1}]}, outputs: [{file: "nose.glb"}]}' >nose.json
run 0 bake nose.json --preview none -o nose
compare nose/nose.glb tracks/tracks.glb --formats sheet -o open/open
stdout_has "open"
compare nose/nose.glb tracks/tracks.glb --formats sheet -o open/open --json
json_has '.files[0] | (.closed | not) and .volume == null and .worst.volume == null and .worst.area != null'

# Two triangles that are welded at rest, one of which flies off.
node -e '
  const rest = [0,0,0, 0,1,0, -1,0,0, 0,1,0, 0,0,0, 1,0,0], moved = [...Array(9).fill(0), 0,0,1, 0,0,1, 0,0,1];
  const data = Buffer.from(new Float32Array([...rest, ...moved, 0, 1, 0, 1]).buffer);
  const accessor = (type, view, count, more) => ({ type, componentType: 5126, bufferView: view, count, ...more });
  console.log(JSON.stringify({
    asset: { version: "2.0" }, scenes: [{ nodes: [0] }], nodes: [{ mesh: 0 }],
    meshes: [{ weights: [0], primitives: [{ attributes: { POSITION: 0 }, targets: [{ POSITION: 1 }] }] }],
    animations: [{ channels: [{ sampler: 0, target: { node: 0, path: "weights" } }], samplers: [{ input: 2, output: 3 }] }],
    accessors: [accessor("VEC3", 0, 6, { min: [-1, 0, 0], max: [1, 1, 0] }), accessor("VEC3", 1, 6, { min: [0, 0, 0], max: [0, 0, 1] }),
      accessor("SCALAR", 2, 2, { min: [0], max: [1] }), accessor("SCALAR", 3, 2)],
    bufferViews: [[0, 72], [72, 72], [144, 8], [152, 8]].map(([byteOffset, byteLength]) => ({ buffer: 0, byteOffset, byteLength })),
    buffers: [{ byteLength: data.length, uri: "data:application/octet-stream;base64," + data.toString("base64") }] }));' >torn.gltf
compare torn.gltf tracks/tracks.glb --formats sheet -o torn/torn --json
stderr_has "torn.gltf#/nodes/0: warning: vertices that are one point at rest are 1 apart at 1 s"
stderr_has "[preview.torn]"
json_has '.files[0].edges == 5 and .files[0].largest_tear == 1 and .files[1].largest_tear == 0'

# The files may also come last.
# shellcheck disable=SC2086
run 0 preview $small --compare -o last/last --formats sheet tracks/tracks.glb eased/eased.glb
[ "$(find last -type f)" = last/last.sheet.png ] || wrong "wrote $(find last -type f)"

# Ctrl-C leaves nothing.
"$program" preview --compare tracks/tracks.glb eased/eased.glb --frames 2000 -o stopped/stopped >"$scratch/stdout" 2>"$scratch/stderr" </dev/null &
comparison=$!
for _ in $(seq 300); do
  grep -q '^preview' "$scratch/stderr" && break
  sleep 0.1
done
kill -INT $comparison
wait $comparison
code=$?
[ $code = 130 ] || wrong "exit code $code after SIGINT"
[ -s "$scratch/stdout" ] && wrong "prints on stdout although it was stopped"
no_file_in stopped

# Wrong files are told all at once, and nothing is written.
rm -rf wrong
run 4 preview --compare tracks/tracks.glb "$shapes/face.glb" "$shapes/bar_straight.glb" -o wrong/wrong
stderr_has "face.glb#/nodes/0: error: the mesh of the node has no morph targets [gltf.no-such-target]"
stderr_has "bar_straight.glb#/nodes/0"
[ -s "$scratch/stdout" ] && wrong "prints on stdout"
run 4 preview --compare tracks/tracks.glb frames/frames.glb --animation walk -o wrong/wrong
stderr_has "[gltf.no-such-animation]"
node -e '
  const fs = require("fs"), bytes = fs.readFileSync("tracks/tracks.glb"), length = bytes.readUInt32LE(12);
  const json = bytes.toString("utf8", 20, 20 + length).replace(/"animations":/, "\"animationz\":");
  fs.writeFileSync("still.glb", Buffer.concat([bytes.subarray(0, 20), Buffer.from(json), bytes.subarray(20 + length)]));'
run 4 preview --compare tracks/tracks.glb still.glb -o wrong/wrong
stderr_has "still.glb"
stderr_has "[gltf.no-such-animation]"
run 2 preview --compare tracks/tracks.glb none.glb -o wrong/wrong
stderr_has "[files.missing]"
run 2 preview --compare tracks/tracks.glb frames/frames.glb -o wrong/wrong --set /turntable/fill=2
no_file_in wrong
finish
