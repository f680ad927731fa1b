#include <fmt/core.h>
#include <fmt/ranges.h>

#include "cli/completion.h"

namespace morphbake::cli {
namespace {

using Kind = ExpectedValue::Kind;

std::string quoted(const std::string& text) {
  std::string quoted = "'";
  for (const char letter : text) {
    if (letter == '\'' || letter == '\\') quoted += '\\';
    quoted += letter;
  }
  return quoted + "'";
}

/// Where completions of a command apply: behind all its words, and none of its own commands.
std::string condition_of(const ExpectedCommand& command) {
  std::string condition = "true";
  std::string words = command.name;
  for (std::size_t end = 0; !words.empty(); words.erase(0, end)) {
    end = std::min(words.find(' '), words.size());
    condition += "; and __fish_seen_subcommand_from " + words.substr(0, end);
    end += end < words.size() ? 1 : 0;
  }
  if (!command.commands.empty()) {
    condition +=
        fmt::format("; and not __fish_seen_subcommand_from {}", fmt::join(command.commands, " "));
  }
  return condition;
}

/// What is offered for a value, and nothing else is, as arguments of `complete`.
std::string offers(const ExpectedValue& value) {
  if (value.kind == Kind::Files && value.endings.empty()) return " -F";
  std::vector<std::string> offered = value.words;
  if (value.kind == Kind::Folders) offered.emplace_back("(__fish_complete_directories)");
  for (const std::string& ending : value.endings) {
    offered.push_back(fmt::format("(__fish_complete_suffix .{})", ending));
  }
  return offered.empty() ? "" : fmt::format(" -f -a '{}'", fmt::join(offered, " "));
}

std::string option_line(const std::string& start, const ExpectedOption& option) {
  std::string line = start;
  for (const std::string& name : option.names) {
    line += name.starts_with("--") ? " -l " + name.substr(2) : " -s " + name.substr(1);
  }
  if (option.takes_value) {
    const std::string offered = offers(option.value);
    line += " -r" + (offered.empty() ? " -f" : offered);
  }
  return line + " -d " + quoted(option.description) + "\n";
}

std::string lines_of(const ExpectedCommand& command, const std::vector<ExpectedCommand>& all) {
  const std::string start = "complete -c morphbake -n " + quoted(condition_of(command));
  std::string lines;
  for (const std::string& word : command.commands) {
    const std::string name = command.name.empty() ? word : command.name + " " + word;
    for (const ExpectedCommand& other : all) {
      if (other.name != name) continue;
      lines += fmt::format("{} -a {} -d {}\n", start, word, quoted(other.description));
    }
  }
  for (const ExpectedOption& option : command.options) lines += option_line(start, option);
  for (const ExpectedValue& argument : command.arguments) {
    const std::string offered = offers(argument);
    if (!offered.empty()) lines += start + offered + "\n";
  }
  return lines;
}

}  // namespace

std::string fish_completion(const std::vector<ExpectedCommand>& commands) {
  std::string script = "# fish completion of morphbake; written by `morphbake completion fish`\n\n";
  script += "complete -c morphbake -f\n";
  for (const ExpectedCommand& command : commands) script += lines_of(command, commands);
  return script;
}

}  // namespace morphbake::cli
