# bash bake_and_check.sh PROGRAM RECIPE SCRATCH CLIENTS: bakes without previews; what is written passes the
# Khronos validator and the rules of real clients. Skips when the recipe's sources are not there.
set -euo pipefail
program=$1 recipe=$2 scratch=$3 clients=$4
folder=$(dirname "$recipe")
grep -oE '"[^"]*\.glb"' "$recipe" | tr -d '"' | grep -v '^out/' | while read -r source; do
  [ -e "$folder/$source" ] || { echo "skipped: $folder/$source is not there"; exit 77; }
done
rm -rf "$scratch"
"$program" bake "$recipe" --output-dir "$scratch" --preview none --report "$scratch/report.json"
for file in "$scratch"/*.glb; do
  node "$clients/validator_test.mjs" "$file"
  node "$clients/structure_test.mjs" "$file"
done
