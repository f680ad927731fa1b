#include <fmt/core.h>
#include <fmt/ranges.h>

#include "cli/completion.h"

namespace morphbake::cli {
namespace {

using Kind = ExpectedValue::Kind;

constexpr const char* kHead =
    R"(# bash completion of morphbake; written by `morphbake completion bash`

)";

// In bash 4 and later, with bash-completion or without it.
constexpr const char* kTail = R"(
# Adds the paths that begin with the current word: of folders, and of files with one of these endings ("*": any).
_morphbake_paths() {
  local ending found
  compopt -o filenames 2>/dev/null
  mapfile -t found < <(compgen -d -- "$cur")
  for ending; do
    mapfile -t -O ${#found[@]} found < <(
      case $ending in
        '*') compgen -f -- "$cur" ;;
        *) compgen -f -X "!*.$ending" -- "$cur"; compgen -f -X "!*.${ending^^}" -- "$cur" ;;
      esac)
  done
  COMPREPLY+=("${found[@]}")
}

_morphbake() {
  local cur=${COMP_WORDS[COMP_CWORD]} command='' option='' arguments=0 options words paths i word
  COMPREPLY=()
  for ((i = 1; i < COMP_CWORD; i++)); do
    word=${COMP_WORDS[i]}
    if [[ $word == '=' ]]; then # readline makes three words of --log=json and of /solve/tolerance=1
      [[ $option ]] || ((++i))
    elif [[ $option ]]; then
      option=''
    elif [[ $word == -* ]]; then
      _morphbake_value "$command" "$word" && option=$word
    elif ((arguments == 0)) && _morphbake_options "${command:+$command }$word"; then
      command=${command:+$command }$word
    else
      ((++arguments))
    fi
  done
  ((i > COMP_CWORD)) && return
  if [[ $cur == '=' ]]; then
    [[ $option ]] || return
    cur=''
  fi
  _morphbake_options "$command"
  if [[ $option ]]; then
    _morphbake_value "$command" "$option"
  elif [[ $cur == -* ]] || ! _morphbake_value "$command" $((arguments + 1)); then
    words=$options paths=''
  fi
  mapfile -t COMPREPLY < <(compgen -W "$words" -- "$cur")
  [[ ${#COMPREPLY[@]} == 1 && ${COMPREPLY[0]} == *= ]] && compopt -o nospace 2>/dev/null
  case $paths in
    '') ;;
    folders) _morphbake_paths ;; # no ending
    *)
      read -ra options <<<"$paths"
      _morphbake_paths "${options[@]}"
      ;;
  esac
}

complete -F _morphbake morphbake
)";

std::string paths_of(const ExpectedValue& value) {
  if (value.kind == Kind::Folders) return "folders";
  if (value.kind != Kind::Files) return "";
  return value.endings.empty() ? "*" : fmt::format("{}", fmt::join(value.endings, " "));
}

/// A line of a `case`: what to do where one of the words stands.
std::string value_line(const std::string& patterns, const ExpectedValue& value) {
  return fmt::format("    {}) words='{}' paths='{}' ;;\n", patterns, fmt::join(value.words, " "),
                     paths_of(value));
}

std::string value_lines(const ExpectedCommand& command) {
  std::string lines;
  for (const ExpectedOption& option : command.options) {
    if (!option.takes_value) continue;
    std::vector<std::string> patterns;
    for (const std::string& name : option.names) {
      patterns.push_back(fmt::format("'{} {}'", command.name, name));
    }
    lines += value_line(fmt::format("{}", fmt::join(patterns, " | ")), option.value);
  }
  if (!command.commands.empty()) {
    lines += value_line(fmt::format("'{} 1'", command.name), {Kind::Words, command.commands});
  }
  for (std::size_t i = 0; i < command.arguments.size(); ++i) {
    const bool is_last = i + 1 == command.arguments.size();
    const std::string number =
        is_last && command.repeats_last_argument ? " '[0-9]*" : fmt::format(" {}'", i + 1);
    lines += value_line(fmt::format("'{}{}", command.name, number), command.arguments[i]);
  }
  return lines;
}

std::vector<std::string> option_names(const ExpectedCommand& command) {
  std::vector<std::string> names;
  for (const ExpectedOption& option : command.options) {
    names.insert(names.end(), option.names.begin(), option.names.end());
  }
  return names;
}

}  // namespace

std::string bash_completion(const std::vector<ExpectedCommand>& commands) {
  std::string script = kHead;
  script += "# Sets the options of a command; fails where there is no such command.\n";
  script += "_morphbake_options() {\n  case $1 in\n";
  for (const ExpectedCommand& command : commands) {
    script += fmt::format("    '{}') options='{}' ;;\n", command.name,
                          fmt::join(option_names(command), " "));
  }
  script += "    *) return 1 ;;\n  esac\n}\n\n";
  script +=
      "# Sets what follows an option of a command, or is its n-th argument; fails where none is.\n";
  script += "_morphbake_value() {\n  case \"$1 $2\" in\n";
  for (const ExpectedCommand& command : commands) script += value_lines(command);
  script += "    *) return 1 ;;\n  esac\n}\n";
  return script + kTail;
}

}  // namespace morphbake::cli
