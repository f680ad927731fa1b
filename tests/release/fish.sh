# Completion in fish: bash fish.sh PROGRAM SCRATCH
. "$(dirname "$0")/../cli/testing.sh"
command -v fish >/dev/null || { echo "SKIPPED: fish is not installed"; exit 77; }
"$program" completion fish >"$scratch/morphbake.fish" || wrong "there is no script"
touch face.glb recipe.json notes.txt
mkdir -p shapes
export HOME="$scratch/cwd" XDG_CONFIG_HOME="$scratch/config" XDG_DATA_HOME="$scratch/data"

offers() { # LINE EXPECTED...: all of them are offered; "!word": not that one
  local line=$1 found word
  shift
  found=$(fish --no-config -c "source '$scratch/morphbake.fish'; complete -C '$line'" | cut -f 1)
  for word; do
    case $word in
      !*) grep -qxF -e "${word#!}" <<<"$found" && wrong "'$line' offers $word: $found" ;;
      *) grep -qxF -e "$word" <<<"$found" || wrong "'$line' does not offer '$word', but: $found" ;;
    esac
  done
}

offers "morphbake " bake inspect landmarks completion '!suggest' '!notes.txt'
offers "morphbake ba" bake '!inspect'
offers "morphbake bake --" --output-dir --set --threads --log --help '!--profile'
offers "morphbake bake " recipe.json
offers "morphbake bake --preview " none recipe '!recipe.json'
offers "morphbake bake recipe.json -o " shapes/ '!notes.txt'
offers "morphbake bake recipe.json --set /solve/tol" /solve/tolerance=
offers "morphbake inspect " face.glb
offers "morphbake lint face.glb --profile " web-three recipe.json
offers "morphbake bake --threads " '!recipe.json'
offers "morphbake landmarks " suggest show '!bake'
offers "morphbake landmarks suggest --" --count --force
finish
