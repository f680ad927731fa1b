# A recipe that must be refused: bash bad_recipe.sh PROGRAM SCRATCH RECIPE EXPECTED
#
# EXPECTED: the exit code, then lines that must each occur on stderr. Nothing may be printed on stdout, no
# file may be left, and --log json must tell the same as JSON lines.
. "$(dirname "$0")/testing.sh"
expected=$4
# Beside the recipe lie two sources, empty: a bad recipe is refused before they are opened.
mkdir "$scratch/recipes"
cp "$(dirname "$3")"/*.json "$scratch/recipes"
touch "$scratch/recipes/a.glb" "$scratch/recipes/b.glb"
echo '{"version": 1, "landmarks": {"nose": {"position": [0, 0, 1]}}}' >"$scratch/recipes/a.landmarks.json"
recipe=$scratch/recipes/$(basename "$3")
files_beside() { find "$(dirname "$recipe")" ! -type d | sort; }

before=$(files_beside)
code=$(head -n 1 "$expected")
refused_with() { # text | json
  run "$code" bake "$recipe" --output-dir "$scratch/out" --log "$1"
  [ -s "$scratch/stdout" ] && wrong "prints on stdout: $(cat "$scratch/stdout")"
  no_file_in "$scratch/out" .
}

refused_with json
stderr_is_json_lines
jq -es 'any(.[]; .severity == "error")' "$scratch/stderr" >/dev/null || wrong "no error in the JSON lines"

refused_with text
while IFS= read -r line; do
  [ -z "$line" ] || stderr_has "$line"
done < <(tail -n +2 "$expected")
[ "$before" = "$(files_beside)" ] || wrong "a file appeared beside the recipe"
finish
