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

baked_seconds() { jq -s 'map(.seconds) | add' "$1/report.jsonl"; } # in the processes of the bakes
timed() { # WHAT DIR BAKES COMMAND...: the overhead is what two cores spent beyond the bakes; BAKES: yes, or no where none is baked
  local what=$1 out=$2 bakes=$3 started ended
  shift 3
  started=$(date +%s.%N)
  "$@" >>out.log 2>&1 </dev/null || { tail -n 20 out.log >&2; exit 1; }
  ended=$(date +%s.%N)
  [ "$bakes" = no ] && bakes=0 || bakes=$(baked_seconds "$out")
  awk -v what="$what" -v s="$started" -v e="$ended" -v bakes="$bakes" -v count=$count 'BEGIN {
    printf "| %s | %.1f s | %.1f s | %.0f ms |\n", what, e - s, bakes / 2, 1000 * (e - s - bakes / 2) / count }'
}
by_batch() { "$MORPHBAKE" batch recipes/library.jsonl -o "$1" -j 2 --cache none; }
by_library() { "$root/pipeline/library" recipes/library.jsonl -o "$1" --cache none "${@:2}"; }

echo "| $count small recipes on two cores | wall | bakes alone | the rest, a recipe |"
echo "|---|---:|---:|---:|"
timed '`morphbake batch`' alone yes by_batch alone
timed "the same again: nothing to do" alone no by_batch alone
timed "\`pipeline/library --shards $shards\`" local yes by_library local --shards $shards
timed "the same again" local no by_library local --shards $shards
start_slurm "$scratch/slurm" 2 1 >&2 || exit 1
timed "\`--slurm --shards $shards\`, two nodes of a core" slurm yes by_library slurm --slurm --shards $shards
timed "the same again" slurm no by_library slurm --slurm --shards $shards
timed "\`--slurm --shards $count\`: a job for about a recipe" single yes by_library single --slurm --shards $count
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
