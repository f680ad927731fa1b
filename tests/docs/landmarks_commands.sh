# bash landmarks_commands.sh PROGRAM ROOT SCRATCH: the commands of docs/landmarks.md on the example shapes; its landmark
# file is shown, and its sources are those of a valid recipe.
set -euo pipefail
program=$1 root=$2 scratch=$3
rm -rf "$scratch"
mkdir -p "$scratch/bin"
ln -s "$program" "$scratch/bin/morphbake"
export PATH="$scratch/bin:$PATH"
cd "$scratch"
cp "$root"/examples/shapes/{cow,giraffe,face}.glb .
cp face.glb other.glb
commands=$(sed -n '/^```sh$/,/^```$/s/^\(morphbake .*\)/\1/p' "$root/docs/landmarks.md")
[ "$(wc -l <<<"$commands")" -ge 4 ] || { echo "docs/landmarks.md has no commands"; exit 1; }
while read -r command; do
  echo "\$ $command"
  $command
done <<<"$commands"
block() { sed -n '/^```json$/,/^```$/p' "$root/docs/landmarks.md" | awk -v n="$1" '/^```json/ { i++; next } !/^```/ && i == n'; }
block 1 >by-hand.json
morphbake landmarks show face.glb --landmarks by-hand.json -o by-hand.png
jq '{version: 1, name: "n", sources: ., timeline: {tracks: [{name: "t", to: "other", begin: 0, end: 1}]}}' \
  <(block 2) >recipe.json
morphbake validate recipe.json
