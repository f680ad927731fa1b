# bash batch_commands.sh PROGRAM ROOT SCRATCH: the commands of docs/batch.md, its list and its table, on example shapes.
. "$(dirname "$0")/commands.sh"
recipe() {
  cat <<RECIPE
{ "version": 1, "name": "$1",
  "sources": { "face": "$root/examples/shapes/face.glb", "other": "$root/examples/shapes/face_long_nose.glb" },
  "timeline": { "tracks": [{ "name": "nose", "to": "other", "begin": 0, "end": 1 }] } }
RECIPE
}
mkdir -p library/{a,b}
for name in library/a/recipe library/b/recipe nose face; do recipe nose >"$name.json"; done
json_block_of docs/batch.md 1 >library.jsonl
sed -n '/^name,/,/^```$/p' "$root/docs/batch.md" | grep -v '^```$' >noses.csv
[ "$(wc -l <noses.csv)" = 3 ] || { echo "docs/batch.md has another table"; exit 1; }
export MORPHBAKE_CACHE=$scratch/cache
commands=$(sed -n '/^```sh$/,/^```$/s/^\(morphbake [^#]*\).*/\1/p' "$root/docs/batch.md")
[ "$(wc -l <<<"$commands")" = 6 ] || { echo "docs/batch.md has other commands"; exit 1; }
while read -r command; do
  echo "\$ $command"
  eval "$command"  # there is a pattern in quotes
done <<<"$commands"
for file in out/{a,b}/recipe/nose.glb out/index.html from-list/nose/slow/nose.glb "noses/long/long nose.glb" parts/report.jsonl parts/index.html; do
  [ -s "$file" ] || { echo "no $file"; exit 1; }
done
