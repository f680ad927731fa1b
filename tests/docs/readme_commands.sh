# bash readme_commands.sh PROGRAM ROOT SCRATCH: the README's `morphbake` commands, on two example sources that
# stand in for the user's own, and its recipe.
set -euo pipefail
program=$1 root=$2 scratch=$3
rm -rf "$scratch"
mkdir -p "$scratch/bin"
ln -s "$program" "$scratch/bin/morphbake"
export PATH="$scratch/bin:$PATH"
cd "$scratch"
for part in glb landmarks.json; do
  cp "$root/examples/shapes/face.$part" "hero.$part"
  cp "$root/examples/shapes/face_long_nose.$part" "villain.$part"
  cp "$root/examples/shapes/face.$part" "face.$part"
  cp "$root/examples/shapes/face_long_nose.$part" "face_long_nose.$part"
done
commands=$(sed -n '/^```sh$/,/^```$/s/^\(morphbake [^#]*\).*/\1/p' "$root/README.md")
[ "$(wc -l <<<"$commands")" -ge 4 ] || { echo "the README has no commands"; exit 1; }
while read -r command; do
  echo "\$ $command"
  $command
done <<<"$commands"
mkdir -p schemas
sed -n '/^```json$/,/^```$/p' "$root/README.md" | grep -v '^```' >readme.json
morphbake bake readme.json --preview none
