# The scripts of the Slurm profile, with clients that answer as told: bash slurm_scripts_test.sh ROOT SCRATCH. Needs no Slurm.
set -u
root=$1 scratch=$2 failures=0
rm -rf "$scratch"
mkdir -p "$scratch"/{clients,"st ate"/{ended,lost,logs}}
state="$scratch/st ate"
cp "$root"/pipeline/workflow/slurm/* "$root/pipeline/workflow/shard" "$state"
export PATH="$scratch/clients:$PATH"
export MORPHBAKE_SLURM_DEADLINE=1 MORPHBAKE_SLURM_PAUSE=1 MORPHBAKE_SLURM_GRACE=3 MORPHBAKE_SLURM_PATIENCE=6
name=morphbake-x shards=20 cores=1
declare -p name shards cores >"$state/settings"

client() { # NAME, lines of what it does; each call is noted
  { echo "#!/bin/sh"; echo "echo \"\$@\" >>'$scratch/$1.calls'"; cat; } >"$scratch/clients/$1"
  chmod +x "$scratch/clients/$1"
  rm -f "$scratch/$1.calls"
}
calls() { if [ -e "$scratch/$1.calls" ]; then wc -l <"$scratch/$1.calls"; else echo 0; fi; }
expect() { # WHAT EXPECTED ACTUAL
  [ "$2" = "$3" ] || { echo "WRONG: $1: '$3' instead of '$2'"; failures=$((failures + 1)); }
}
status() { (cd / && "$state/status" "$1"); }
begin() { rm -f "$state"/queue* "$state"/lost/* "$state"/ended/* "$state"/submit.*; }

# status: the job's own word needs no Slurm.
begin
client squeue <<<"sleep 100"
echo 0 >"$state/ended/7"
echo 6 >"$state/ended/8"
expect "ended well" success "$(status 7)"
expect "ended badly" failed "$(status 8)"
expect "calls for what is known" 0 "$(calls squeue)"

# A controller that hangs, or refuses: running until patience ends, each answer within the deadline.
for away in "sleep 100" "echo slurm_load_jobs error: Unable to contact slurm controller >&2; exit 1" "echo nonsense; exit 1"; do
  begin
  client squeue <<<"$away"
  started=$(date +%s)
  expect "first answer while Slurm is away" running "$(status 9)"
  [ $(($(date +%s) - started)) -le 4 ] || expect "deadline" "4 s" "$(($(date +%s) - started)) s"
  sleep 3
  expect "while Slurm is away" running "$(status 9)"
  sleep 4
  expect "patience" failed "$(status 9)"
done

# States; one call serves all jobs of a moment.
begin
client squeue <<<'printf "%s\n" "1 PENDING" "2 RUNNING" "3 COMPLETING" "4 REQUEUED" "5 FAILED" "11 TIMEOUT" "55 RUNNING"'
for job in 1 2 3 4; do expect "state of job $job" running "$(status $job)"; done
[ "$(calls squeue)" -le 2 ] || expect "calls for four jobs" "1 or 2" "$(calls squeue)"
expect "job 5 within the grace" running "$(status 5)"
expect "a job that Slurm forgot, within the grace" running "$(status 99)"
sleep 4
for job in 5 11 99; do [ $job = 11 ] || expect "job $job after the grace" failed "$(status $job)"; done
expect "job 11 is first asked of" running "$(status 11)"
echo 0 >"$state/ended/99"
expect "its word comes late" success "$(status 99)"

# A forgotten job that comes back (requeued) is not lost; being away does not use up the grace.
begin
client squeue <<<'echo "6 NODE_FAIL"'
expect "node failed" running "$(status 6)"
client squeue <<<'echo "6 PENDING"'
sleep 4
expect "requeued" running "$(status 6)"
[ ! -e "$state/lost/6" ] || expect "mark of a job that is back" none "lost/6"
client squeue <<<'echo "6 NODE_FAIL"'
sleep 1
expect "node failed again" running "$(status 6)"
client squeue <<<"exit 1"
sleep 4
expect "away within the grace" running "$(status 6)"

# Marks that are torn, empty, or of the future.
begin
client squeue <<<'echo "6 RUNNING"'
for mark in "" "x" "99999999999" "-1"; do
  printf %s "$mark" >"$state/queue.asked"
  printf %s "$mark" >"$state/queue.answered"
  printf %s "$mark" >"$state/lost/6"
  expect "marks of '$mark'" running "$(status 6)"
done
expect "a strange id" running "$(status 'x/[')"

# submit: the id, also while Slurm is away at first; what it refuses is not asked again.
submit() { (cd / && "$state/submit" 4 "job script" 2>"$scratch/stderr"); echo "exit $?"; }
begin
client sbatch <<<'echo "123;cluster"'
expect "job id" "123 exit 0" "$(submit | tr '\n' ' ' | sed 's/ $//')"
grep -q -- "--requeue" "$scratch/sbatch.calls" || expect "sbatch's words" --requeue "$(cat "$scratch/sbatch.calls")"
begin
client sbatch <<<"[ \$(wc -l <'$scratch/sbatch.calls') -ge 3 ] && echo 124 && exit; echo 'sbatch: error: Unable to contact slurm controller (connect failure)' >&2; exit 1"
expect "away, then there" "124 exit 0" "$(submit | tr '\n' ' ' | sed 's/ $//')"
expect "calls" 3 "$(calls sbatch)"
begin
client sbatch <<<'echo "sbatch: error: invalid partition specified: fast" >&2; exit 1'
expect "refused" "exit 1" "$(submit)"
expect "calls when refused" 1 "$(calls sbatch)"
grep -q "shard 4: .*invalid partition" "$scratch/stderr" || expect "reason" "invalid partition" "$(cat "$scratch/stderr")"
begin
client sbatch <<<'sleep 100'
expect "never there" "exit 1" "$(submit)"
[ "$(calls sbatch)" -gt 1 ] || expect "calls while away" "several" "$(calls sbatch)"
client sbatch <<<'sleep 100'
expect "never there, next shard" "exit 1" "$(submit)"
expect "calls of the next shard" 1 "$(calls sbatch)"

# shard: which codes of `morphbake batch` end a job well, which badly, and which say nothing.
start=$scratch batch=("$scratch/clients/batch" "a b")
declare -p name shards cores start batch >"$state/settings"
for case in "0 0 0" "3 0 0" "1 1 1" "2 2 2" "6 6 6" "130 130 none" "137 137 none"; do
  read -r code exit word <<<"$case"
  begin
  rm -rf "$state/done"
  client batch <<<"exit $code"
  (cd / && "$state/shard" 5)
  expect "exit code of a shard after $code" "$exit" $?
  expect "word of a shard after $code" "$word" "$(cat "$state/ended/local-5" 2>/dev/null || echo none)"
  expect "done after $code" "$([ "$exit" = 0 ] && echo yes || echo no)" "$([ -e "$state/done/5" ] && echo yes || echo no)"
  expect "arguments" "a b --shard 5/20" "$(cat "$scratch/batch.calls")"
done

[ $failures = 0 ] && echo "all right"
exit $((failures > 0))
