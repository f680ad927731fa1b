# Completion in a real bash: bash completion.sh PROGRAM SCRATCH
. "$(dirname "$0")/../cli/testing.sh"
"$program" completion bash >"$scratch/morphbake" || wrong "there is no script"
mkdir -p "a folder" shapes
touch face.glb other.GLTF "a b.glb" recipe.json notes.txt picture.png shapes/cow.glb
. "$scratch/morphbake"

# What TAB offers behind a command line, sorted, a space between: the last word is the one to complete.
offered() {
  COMP_WORDS=("$@")
  COMP_CWORD=$(($# - 1))
  COMPREPLY=()
  _morphbake
  printf '%s\n' "${COMPREPLY[@]}" | sort -u | paste -sd ' '
}

offers() { # EXPECTED WORDS...
  local expected=$1 found
  shift
  found=$(LC_ALL=C offered "$@")
  [ "$found" = "$expected" ] || wrong "'$*' offers '$found' instead of '$expected'"
}

offers_also() { # EXPECTED WORDS...
  local found
  found=" $(offered "${@:2}") "
  [[ $found == *" $1 "* ]] || wrong "'${*:2}' does not offer '$1', but$found"
}

# Names that the help of a command has, in the lines of its options: "-o,--output-dir PATH".
options_in_help() { "$program" "$@" --help | sed -n '/^Options:/,/^[A-Z].*[^:]$/s/^  \(-[^ ]*\).*/\1/p' | tr ',' '\n'; }
commands_in_help() { "$program" "$@" --help | sed -n '/^Subcommands:/,/^$/s/^  \([a-z][a-z-]*\) .*/\1/p' | sort -u; }
together() { LC_ALL=C sort -u | paste -sd ' '; }

# Each command and each option of the help is offered, and none besides: whatever commands there will be.
check_command() { # WORDS OF THE COMMAND...
  local commands options
  commands=$(commands_in_help "$@")
  options=$({ options_in_help "$@"; options_in_help; } | together)
  [ "$(wc -w <<<"$options")" -ge 5 ] || wrong "few options in the help of '$*': $options"
  offers "$options" morphbake "$@" -
  [ -z "$commands" ] || offers "$(together <<<"$commands")" morphbake "$@" ""
  checked=$((checked + 1))
  for command in $commands; do check_command "$@" "$command"; done
}
checked=0
check_command
[ $checked -ge 14 ] || wrong "only $checked commands"


# Files by their type, and folders on the way to them.
offers "a folder recipe.json shapes" morphbake bake ""
offers "recipe.json" morphbake bake r
offers "a b.glb a folder face.glb other.GLTF shapes" morphbake inspect ""
offers "shapes/cow.glb" morphbake inspect shapes/
offers "a b.glb a folder face.glb other.GLTF shapes" morphbake init face.glb ""
offers "a b.glb a folder face.glb other.GLTF shapes" morphbake diff face.glb ""
offers "a b.glb a folder face.glb other.GLTF shapes" morphbake landmarks suggest face.glb ""
offers "a folder picture.png shapes" morphbake inspect face.glb --weights ""
offers "a folder shapes" morphbake bake recipe.json -o ""
offers "a folder shapes" morphbake bake recipe.json --output-dir ""
offers "a folder shapes" morphbake golden recipe.json --golden-dir ""
offers "" morphbake bake recipe.json -o r

# Words; also behind "=", which readline makes a word of its own.
offers "json text" morphbake --log ""
offers "json text" morphbake --log =
offers "json" morphbake --log = j
offers "bake" morphbake --log = json bak
offers "bake" morphbake --log json --quiet bak
offers "none recipe" morphbake bake --preview ""
offers "show suggest" morphbake landmarks ""
offers "bash fish" morphbake completion ""
offers "/solve/tolerance=" morphbake bake recipe.json --set /solve/tol
offers "" morphbake bake recipe.json --set /solve/tolerance = 1
offers "" morphbake bake recipe.json --set /solve/tolerance =
offers "recipe.json" morphbake bake --set /solve/tolerance = 1 r
offers "web-three" morphbake lint face.glb --profile web-t
offers "recipe.json" morphbake lint face.glb --profile rec
offers "" morphbake bake recipe.json --threads ""
offers_also --preview morphbake bake recipe.json ""
offers "" morphbake nonsense x
touch '*' '$(touch broken)'
offers "face.glb" morphbake inspect f
[ -e broken ] && wrong "a file's name was run"

# As an interactive shell loads it: bash-completion finds it by its place, TAB writes the rest of the word.
if [ -e /usr/share/bash-completion/bash_completion ]; then
  mkdir -p "$scratch/share/bash-completion/completions"
  cp "$scratch/morphbake" "$scratch/share/bash-completion/completions/morphbake"
  printf '%s\n' 'stty cols 200' "PS1='> '" '. /usr/share/bash-completion/bash_completion' >rc
  { sleep 1; printf 'morphbake insp\tfa\t--js\t\n'; sleep 1; printf 'exit\n'; } |
    XDG_DATA_DIRS="$scratch/share" TERM=dumb timeout 20 \
      script -qec 'bash --noprofile --rcfile rc -i' /dev/null >"$scratch/typed" 2>&1
  grep -q 'morphbake inspect face.glb --json' "$scratch/typed" || wrong "TAB completes nothing: $(cat -v "$scratch/typed")"
else
  echo "not tried: bash-completion is not installed"
fi
finish
