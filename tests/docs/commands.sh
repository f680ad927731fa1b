# What the scripts share that run the commands of a document: `. commands.sh`. Arguments of each: PROGRAM ROOT SCRATCH.
set -euo pipefail
program=$1 root=$2 scratch=$3
rm -rf "$scratch"
mkdir -p "$scratch/bin"
ln -s "$program" "$scratch/bin/morphbake"
export PATH="$scratch/bin:$PATH"
cd "$scratch"

# The `morphbake` commands of a document's shell blocks are run; there have to be four or more.
run_commands_of() {
  local document=$1 commands command
  commands=$(sed -n '/^```sh$/,/^```$/s/^\(morphbake [^#]*\).*/\1/p' "$root/$document")
  [ "$(wc -l <<<"$commands")" -ge 4 ] || { echo "$document has too few commands"; exit 1; }
  while read -r command; do
    echo "\$ $command"
    $command
  done <<<"$commands"
}

# The n-th JSON block of a document, counted from 1.
json_block_of() {
  sed -n '/^```json$/,/^```$/p' "$root/$1" | awk -v n="$2" '/^```json/ { i++; next } !/^```/ && i == n'
}
