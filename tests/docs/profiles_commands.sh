# bash profiles_commands.sh PROGRAM ROOT SCRATCH: the commands of docs/profiles.md on a morph of the example shapes, and
# its profile.
. "$(dirname "$0")/commands.sh"
cat >nose.json <<RECIPE
{ "version": 1, "name": "nose",
  "sources": { "face": "$root/examples/shapes/face.glb", "other": "$root/examples/shapes/face_long_nose.glb" },
  "timeline": { "tracks": [{ "name": "nose", "to": "other", "begin": 0, "end": 1 }] },
  "outputs": [{ "file": "morph.glb" }] }
RECIPE
morphbake bake nose.json --preview none
json_block_of docs/profiles.md 1 >ours.json
run_commands_of docs/profiles.md
[ -s weights.png ]
