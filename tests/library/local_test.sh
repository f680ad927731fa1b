# pipeline/library on this machine: bash local_test.sh PROGRAM ROOT SCRATCH
. "$(dirname "$0")/library.sh"
command -v snakemake >/dev/null || skip "snakemake is not installed (apt-get install --no-install-recommends snakemake: 680 MB with what it needs)"
rm -rf "$scratch"
mkdir -p "$scratch"
cd "$scratch" || exit 1
make_library "$scratch/recipes" 24

# The same bytes as `batch` alone; a folder of any name; the second run has nothing to do.
plain=$'a "plain"\n$HOME \'földer\''
"$MORPHBAKE" batch recipes/library.jsonl -o alone --cache none >/dev/null 2>&1 || wrong "batch alone failed"
library 0 recipes/library.jsonl -o "$plain" --shards 5
stderr_has '5 of 5 shards done'
stderr_has '24 of 24 recipes done, 0 failed; 5 shards in [0-9]+ s, 0 of them started again, 0 unfinished'
[ -s "$plain/index.html" ] || wrong "no page"
same_results alone "$plain" 24
touch "$scratch/before"
library 0 recipes/library.jsonl -o "$plain" --shards 5
[ -z "$(find "$plain" -mindepth 2 -name '*.glb' -newer before)" ] || wrong "the second run baked again"

# Failed recipes are no failed shards; mended, they are all that is baked.
make_library "$scratch/broken" 24
mv broken/recipes/r7.json broken/kept.json
echo '{' >broken/recipes/r7.json
library 3 broken/library.jsonl -o out --shards 3 --preview none
stderr_has '23 of 24 recipes done, 1 failed; 3 shards in .* 0 unfinished'
[ "$(wc -l <out/failures.jsonl)" = 1 ] || wrong "failures: $(cat out/failures.jsonl)"
mv broken/kept.json broken/recipes/r7.json
touch "$scratch/before"
library 0 broken/library.jsonl -o out --shards 3 --preview none
[ "$(find out -name '*.glb' -newer before)" = out/recipes/r7/r7.glb ] || wrong "baked again: $(find out -name '*.glb' -newer before)"

# Wrong lists and options are told once, before any shard.
library 2 recipes/no.jsonl -o none --shards 4
[ "$(grep -c 'error:' "$scratch/stderr")" = 1 ] || { wrong "told more than once"; cat "$scratch/stderr"; }
library 2 recipes/library.jsonl -o none --shards 0x
library 2 recipes/library.jsonl -o none --shard 1/2
library 2 recipes/library.jsonl -o none --no-such-option
library 2 recipes/library.jsonl -o
library 2
stderr_has "which manifest"

# Two at a time in one folder; a folder that cannot be written; shards that end badly.
mkdir -p busy/.library
exec 8>busy/.library/lock
flock 8
library 6 recipes/library.jsonl -o busy
stderr_has "another pipeline/library works in busy"
exec 8>&-
echo >file
library 6 recipes/library.jsonl -o file
printf '%s\n' '#!/bin/sh' 'case "$*" in *--shard*) exit 6 ;; esac' "exec '$MORPHBAKE' \"\$@\"" >unwell
chmod +x unwell
MORPHBAKE=$scratch/unwell library 6 recipes/library.jsonl -o ill --shards 2
stderr_has '0 of 24 recipes done, 24 failed; 2 shards .* 2 unfinished'

# Ctrl-C stops what is being baked; the same command goes on.
make_library "$scratch/many" 200
"$root/pipeline/library" many/library.jsonl -o stopped --shards 4 >"$scratch/stdout" 2>"$scratch/stderr" </dev/null &
pipeline=$!
for _ in $(seq 300); do
  [ "$(cat stopped/report.*-of-4.jsonl 2>/dev/null | wc -l)" -ge 10 ] && break
  sleep 0.1
done
kill -TERM $pipeline
wait $pipeline
code=$?
[ $code = 130 ] || wrong "exit code $code after SIGTERM"
stderr_has "interrupted; the same command goes on from here"
baked=$(find stopped -name '*.glb' -not -path '*/.*' | wc -l)
[ "$(wc -l <stopped/.library/starts)" -le 2 ] || wrong "went on after SIGTERM: $(cat stopped/.library/starts)"
[ "$baked" -ge 10 ] && [ "$baked" -lt 150 ] || wrong "$baked baked when it was stopped"
[ -z "$(find stopped -name '*.glb' -path '*/.*' -o -name '*.tmp')" ] || wrong "half-written files"
touch "$scratch/before"
library 0 many/library.jsonl -o stopped --shards 4
again=$(find stopped -name '*.glb' -not -path '*/.*' -newer before | wc -l)
[ "$again" = $((200 - baked)) ] || wrong "$again baked after $baked of 200"
finish
