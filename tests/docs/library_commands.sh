# bash library_commands.sh PROGRAM ROOT SCRATCH: the commands of docs/library.md that need no Slurm. Without Snakemake they are skipped.
. "$(dirname "$0")/commands.sh"
command -v snakemake >/dev/null || { echo "SKIPPED: snakemake is not installed"; exit 77; }
node "$root/tests/library/recipes.mjs" . 6
cp recipes/r0.json face.json && sed -i 's|"\.\./|"|g' face.json
printf '%s\n' 'name,/timeline/tracks/0/end' 'short,0.5' 'long,4' >noses.csv
export MORPHBAKE=$program
commands=$(sed -n '/^```sh$/,/^```$/s/^\(pipeline\/library [^#]*\).*/\1/p' "$root/docs/library.md" | grep -v -e --slurm)
[ "$(wc -l <<<"$commands")" -ge 3 ] || { echo "docs/library.md has too few commands"; exit 1; }
while read -r command; do
  echo "\$ $command"
  "$root"/$command </dev/null
done <<<"$commands"
[ -s out/index.html ] && [ "$(find noses -name '*.glb' -not -path '*/.*' | wc -l)" = 2 ] || { echo "results are missing"; exit 1; }
