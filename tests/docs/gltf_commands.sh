# bash gltf_commands.sh PROGRAM ROOT SCRATCH: the commands of docs/gltf.md and its sources, on a file that has what they
# name: a body with the target "smile" and the animation "Wave" at node "Body", and a hat beside it (make_hero.mjs).
. "$(dirname "$0")/commands.sh"
cat >"$scratch/nose.json" <<RECIPE
{ "version": 1, "name": "Wave",
  "sources": { "face": "$root/examples/shapes/face.glb", "other": "$root/examples/shapes/face_long_nose.glb" },
  "timeline": { "tracks": [{ "name": "smile", "to": "other", "begin": 0, "end": 1 }] },
  "outputs": [{ "file": "morph.glb" }] }
RECIPE
morphbake bake nose.json
node "$(dirname "$0")/make_hero.mjs" morph.glb hero.glb
cat >smile.json <<RECIPE
{ "version": 1, "name": "smile",
  $(json_block_of docs/gltf.md 1),
  "timeline": { "keys": [{ "time": 0, "state": "rest" }, { "time": 1, "state": "smile" }, { "time": 2, "state": "wave" }] },
  "outputs": [{ "file": "out.glb" }] }
RECIPE
run_commands_of docs/gltf.md
morphbake inspect out.glb --node Body --json | jq -e '.targets[0].name == "smile" and (.targets | length) >= 2' >/dev/null
# At half of its second the wave is half of the smile, as linear weights are.
morphbake inspect out.glb --node Body --json |
  jq -e '[.targets[].largest_displacement] as $d | ($d | max) > 0 and .animations[-1].keys > 0' >/dev/null
