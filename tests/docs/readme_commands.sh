# bash readme_commands.sh PROGRAM ROOT SCRATCH: the README's `morphbake` commands, on two example sources that
# stand in for the user's own, and its recipe.
. "$(dirname "$0")/commands.sh"
for part in glb landmarks.json; do
  cp "$root/examples/shapes/face.$part" "hero.$part"
  cp "$root/examples/shapes/face_long_nose.$part" "villain.$part"
  cp "$root/examples/shapes/face.$part" "face.$part"
  cp "$root/examples/shapes/face_long_nose.$part" "face_long_nose.$part"
done
run_commands_of README.md
mkdir -p schemas
json_block_of README.md 1 >readme.json
morphbake bake readme.json --preview none
