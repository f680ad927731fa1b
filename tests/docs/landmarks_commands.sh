# bash landmarks_commands.sh PROGRAM ROOT SCRATCH: the commands of docs/landmarks.md on the example shapes; its landmark
# file is shown, and its sources are those of a valid recipe.
. "$(dirname "$0")/commands.sh"
cp "$root"/examples/shapes/{cow,giraffe,face}.glb .
cp face.glb other.glb
run_commands_of docs/landmarks.md
json_block_of docs/landmarks.md 1 >by-hand.json
morphbake landmarks show face.glb --landmarks by-hand.json -o by-hand.png
jq '{version: 1, name: "n", sources: ., timeline: {tracks: [{name: "t", to: "other", begin: 0, end: 1}]}}' \
  <(json_block_of docs/landmarks.md 2) >recipe.json
morphbake validate recipe.json
