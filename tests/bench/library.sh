# What shards, Snakemake and Slurm cost: bash library.sh PROGRAM ROOT prints Markdown. As root, with Slurm, on two cores.
set -u
export MORPHBAKE=$1
root=$2
PATH=$PATH:/usr/sbin
. "$root/tests/library/slurm.sh"
scratch=$(mktemp -d /tmp/library.XXXXXX) && chmod 755 "$scratch" || exit 1
trap 'stop_slurm; rm -rf "$scratch"' EXIT
trap 'exit 1' INT TERM HUP
cd "$scratch" || exit 1
count=200 shards=10
node "$root/tests/library/recipes.mjs" recipes $count || exit 1

now() { date +%s.%N; }
row() { # WHAT SECONDS [CORES]: overhead is what each core spent beyond the bakes
  awk -v what="$1" -v seconds="$2" -v cores="${3:-2}" -v bakes="$bakes" -v count=$count 'BEGIN {
    printf "| %s | %.1f s | %.0f ms |\n", what, seconds, 1000 * (seconds * cores - bakes) / count }'
}
timed() { # WHAT CORES COMMAND...
  local started what=$1 cores=$2
  shift 2
  started=$(now)
  "$@" >>out.log 2>&1 </dev/null || { tail -n 20 out.log >&2; exit 1; }
  row "$what" "$(awk -v a="$started" -v b="$(now)" 'BEGIN { print b - a }')" "$cores"
}

"$MORPHBAKE" batch recipes/library.jsonl -o first -j 2 --cache none >/dev/null 2>&1 || exit 1
bakes=$(jq -s 'map(.seconds) | add' first/report.jsonl) || exit 1
echo "| $count recipes, $(awk -v b="$bakes" -v n=$count 'BEGIN { printf "%.2f s", b / n }') each in its process, on two cores | wall | overhead a recipe |"
echo "|---|---:|---:|"
timed "\`morphbake batch\`" 2 "$MORPHBAKE" batch recipes/library.jsonl -o alone -j 2 --cache none
timed "the same again: nothing to do" 2 "$MORPHBAKE" batch recipes/library.jsonl -o alone -j 2 --cache none
timed "\`pipeline/library --shards $shards\`" 2 "$root/pipeline/library" recipes/library.jsonl -o local --shards $shards --cache none
timed "the same again" 2 "$root/pipeline/library" recipes/library.jsonl -o local --shards $shards --cache none
start_slurm "$scratch/slurm" 2 1 >&2 || exit 1
timed "\`--slurm --shards $shards\`, two nodes of a core" 2 "$root/pipeline/library" recipes/library.jsonl -o slurm --slurm --shards $shards --cache none
timed "the same again" 2 "$root/pipeline/library" recipes/library.jsonl -o slurm --slurm --shards $shards --cache none
timed "\`--slurm --shards $count\`: a job is a recipe or none" 2 "$root/pipeline/library" recipes/library.jsonl -o single --slurm --shards $count --cache none
stop_slurm

echo
echo "| shards of 500 recipes | recipes | Snakemake plans them in | and takes |"
echo "|---:|---:|---:|---:|"
mkdir -p dag/state && cp "$root/pipeline/workflow/Snakefile" dag && cd dag || exit 1
for shards in 200 2000 20000; do
  /usr/bin/time -f "%e s | %M" -o ../time snakemake -n --quiet all --config shards=$shards cores=1 --nolock --scheduler greedy --cores 1 >/dev/null 2>&1 || exit 1
  echo "| $shards | $((500 * shards)) | $(awk '{ printf "%s s | %.0f MB", $1, $4 / 1000 }' ../time) |"
done
cd ..

echo
"$MORPHBAKE" batch recipes/library.jsonl -o cached -j 2 --cache "$scratch/cache" >/dev/null 2>&1 || exit 1
echo "The cache of these $count recipes over 40 connectivities holds $(find cache -type f | wc -l) files, $(du -sk cache | awk '{ printf "%.1f", $1 / 1024 }') MB:" \
  "$(find cache -type f | wc -l | awk -v n=$count '{ printf "%.1f", $1 / n }') files and $(du -sk cache | awk -v n=$count '{ printf "%.0f", $1 / n }') kB a recipe."
