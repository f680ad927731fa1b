# pipeline/library --slurm on two nodes of a real Slurm, of which one dies: bash slurm_test.sh PROGRAM ROOT SCRATCH
. "$(dirname "$0")/library.sh"
. "$(dirname "$0")/slurm.sh"
[ "$(id -u)" = 0 ] || skip "Slurm's daemons want root"
PATH=$PATH:/usr/sbin
for command in snakemake slurmctld slurmd sbatch munged; do
  command -v $command >/dev/null || skip "$command is not installed; pipeline/test --all does"
done
rm -rf "$scratch"
mkdir -p "$scratch"
cd "$scratch" || exit 1
folder=$(mktemp -d /tmp/slurm.XXXXXX) && chmod 755 "$folder" || exit 1
pipeline=''
clean_up() {
  [ -z "$pipeline" ] || kill "$pipeline" 2>/dev/null
  stop_slurm
  [ $failures = 0 ] || tail -n 30 "$folder"/*.log
  rm -rf "$folder"
}
trap clean_up EXIT
trap 'exit 1' INT TERM HUP
start_slurm "$folder" 2 1 || { wrong "no Slurm"; exit 1; }

make_library "$scratch/recipes" 200
"$MORPHBAKE" batch recipes/library.jsonl -o alone --cache none >/dev/null 2>&1 || wrong "batch alone failed"

# A node dies in the middle of a shard, when some of its recipes are baked and some are not.
MORPHBAKE_SLURM_PAUSE=2 MORPHBAKE_SLURM_DEADLINE=5 "$root/pipeline/library" recipes/library.jsonl -o "by slurm" --slurm --shards 10 \
  >"$scratch/stdout" 2>"$scratch/stderr" </dev/null &
pipeline=$!
killed=''
for _ in $(seq 1200); do
  read -r shard job node < <(grep ' n1$' "by slurm/.library/starts" 2>/dev/null | tail -n 1) || true
  lines=$(wc -l 2>/dev/null <"by slurm/report.${shard:-0}-of-10.jsonl")
  if [ -n "${job-}" ] && [ "${lines:-0}" -ge 3 ] && [ ! -e "by slurm/.library/ended/$job" ]; then
    kill_node 1
    killed=$job
    break
  fi
  sleep 0.05
done
[ -n "$killed" ] || wrong "no shard was caught in the middle"
[ ! -e "by slurm/.library/ended/$killed" ] || wrong "the shard ended before its node was killed"
echo "node n1 died in job $killed with shard $shard after $lines recipes"

# The controller is away for a while as well, as for an update.
sleep 15
stop_controller
sleep 20
start_controller || wrong "no second controller"

wait $pipeline
code=$?
pipeline=''
[ $code = 0 ] || { wrong "exit code $code of pipeline/library --slurm"; }
cat "$scratch/stderr"
stderr_has '200 of 200 recipes done, 0 failed; 10 shards in [0-9]+ s, 1 of them started again, 0 unfinished'
[ "$(grep -c "^$shard $killed " "by slurm/.library/starts")" = 2 ] || wrong "job $killed was not requeued: $(cat "by slurm/.library/starts")"
grep -q "JobId=$killed .*JobState=NODE_FAIL" "$folder/jobs" || wrong "Slurm does not know that the node failed: $(cat "$folder/jobs")"
same_results alone "by slurm" 200

# The node is back: a second run starts every shard and bakes nothing.
start_node 1
touch "$scratch/before"
MORPHBAKE_SLURM_PAUSE=2 library 0 recipes/library.jsonl -o "by slurm" --slurm --shards 10
[ -z "$(find "by slurm" -mindepth 2 -name '*.glb' -not -path '*/.*' -newer before)" ] || wrong "the second run baked again"

# What Slurm refuses is told; Ctrl-C takes jobs out of its queue.
SBATCH_PARTITION=none library 3 recipes/library.jsonl -o refused --slurm --shards 2
stderr_has "shard [12]: no job .*[Ii]nvalid partition"
"$root/pipeline/library" recipes/library.jsonl -o stopped --slurm --shards 10 >/dev/null 2>"$scratch/stderr" </dev/null &
pipeline=$!
for _ in $(seq 300); do [ -s stopped/.library/starts ] && break; sleep 0.1; done
sleep 1
kill -INT $pipeline
kill -TERM $pipeline
wait $pipeline
code=$?
pipeline=''
[ $code = 130 ] || { wrong "exit code $code after Ctrl-C"; cat "$scratch/stderr"; }
for _ in $(seq 60); do [ -z "$(squeue --noheader)" ] && break; sleep 0.5; done
[ -z "$(squeue --noheader)" ] || wrong "jobs are left: $(squeue)"
finish
