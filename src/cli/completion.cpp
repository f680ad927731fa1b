#include "cli/completion.h"

#include <algorithm>
#include <cctype>
#include <sstream>
#include <string_view>

#include "morphbake/bake/options.h"
#include "morphbake/json/json.h"
#include "morphbake/profile/profile.h"

namespace morphbake::cli {
namespace {

using Kind = ExpectedValue::Kind;

struct FileType {
  std::string_view said;  ///< in the description of an option
  std::vector<std::string> endings;
};

const FileType kFileTypes[] = {
    {"glTF", {"glb", "gltf"}}, {".glb", {"glb", "gltf"}}, {"JSON", {"json"}},
    {".json", {"json"}},       {".jsonl", {"jsonl"}},     {"JSON lines", {"jsonl"}},
    {"JSON-lines", {"jsonl"}}, {".png", {"png"}},         {"XML", {"xml"}},
    {".html", {"html"}},       {".csv", {"csv"}}};

/// "a", "b" of "TEXT:{a,b}": what CLI::IsMember says of itself.
std::vector<std::string> choices_in(const std::string& type) {
  const std::size_t open = type.find('{'), close = type.find('}');
  std::vector<std::string> choices;
  if (open == std::string::npos || close == std::string::npos) return choices;
  std::istringstream text(type.substr(open + 1, close - open - 1));
  for (std::string choice; std::getline(text, choice, ',');) choices.push_back(choice);
  return choices;
}

/// "/solve/tolerance=" and all the others.
std::vector<std::string> settable_pointers() {
  std::vector<std::string> pointers;
  const Json options = Json::parse(options_to_json({})).flatten();
  for (const auto& [pointer, value] : options.items()) {
    const char last = pointer.back();
    const bool is_in_list = std::isdigit(static_cast<unsigned char>(last)) != 0;
    if (!is_in_list && pointer.front() == '/' && pointer[1] != '$') {
      pointers.push_back(pointer + "=");
    }
  }
  return pointers;
}

bool is_folder(const CLI::Option& option) {
  const std::string name = option.get_name(true, true);
  const std::string& text = option.get_description();
  return name.find("-dir") != std::string::npos || text.find("folder") != std::string::npos ||
         text.find("Folder") != std::string::npos;
}

std::vector<std::string> endings_in(const std::string& description) {
  std::vector<std::string> endings;
  if (description.starts_with("Stem")) return endings;
  for (const FileType& type : kFileTypes) {
    if (description.find(type.said) == std::string::npos) continue;
    for (const std::string& ending : type.endings) {
      if (std::ranges::find(endings, ending) == endings.end()) endings.push_back(ending);
    }
  }
  return endings;
}

ExpectedValue value_of(const CLI::Option& option) {
  const std::string type = option.get_type_name();
  const std::vector<std::string> choices = choices_in(type);
  if (!choices.empty()) return {Kind::Words, choices};
  if (type.starts_with("/POINTER")) return {Kind::Words, settable_pointers()};
  if (type.starts_with("PROFILE")) return {Kind::Files, profile_names(), {"json"}};
  if (!type.starts_with("PATH")) return {};
  if (is_folder(option)) return {Kind::Folders};
  return {Kind::Files, {}, endings_in(option.get_description())};
}

ExpectedOption expected_option(const CLI::Option& option) {
  ExpectedOption expected;
  for (const std::string& name : option.get_snames()) expected.names.push_back("-" + name);
  for (const std::string& name : option.get_lnames()) expected.names.push_back("--" + name);
  expected.description = option.get_description();
  expected.takes_value = option.get_items_expected_max() > 0;
  if (expected.takes_value) expected.value = value_of(option);
  return expected;
}

bool is_shown(const CLI::Option& option) { return !option.get_group().empty(); }

void add_own(const CLI::App& app, ExpectedCommand& command) {
  for (const CLI::Option* option : app.get_options()) {
    if (!is_shown(*option)) continue;
    if (option->nonpositional()) {
      command.options.push_back(expected_option(*option));
      continue;
    }
    ExpectedValue value = value_of(*option);
    // "Another one" is one like that before it.
    const bool says_nothing = value == ExpectedValue{Kind::Files};
    if (says_nothing && !command.arguments.empty()) value = command.arguments.back();
    command.arguments.push_back(value);
    command.repeats_last_argument = option->get_items_expected_max() > 1;
  }
}

/// The options of what a command belongs to, that it does not have itself.
void add_inherited(const ExpectedCommand& parent, ExpectedCommand& command) {
  for (const ExpectedOption& option : parent.options) {
    const bool is_own = std::ranges::any_of(command.options, [&](const ExpectedOption& own) {
      return own.names.back() == option.names.back();
    });
    if (!is_own) command.options.push_back(option);
  }
}

void add_command(const CLI::App& app, const std::string& name, const ExpectedCommand* parent,
                 std::vector<ExpectedCommand>& commands) {
  ExpectedCommand command;
  command.name = name;
  command.description = app.get_description();
  add_own(app, command);
  if (parent != nullptr) add_inherited(*parent, command);
  std::vector<const CLI::App*> parts;
  for (const CLI::App* part : app.get_subcommands(std::function<bool(const CLI::App*)>())) {
    if (part->get_group().empty()) continue;
    parts.push_back(part);
    command.commands.push_back(part->get_name());
  }
  commands.push_back(command);
  for (const CLI::App* part : parts) {
    const std::string part_name = (name.empty() ? "" : name + " ") + part->get_name();
    add_command(*part, part_name, &command, commands);
  }
}

}  // namespace

std::vector<ExpectedCommand> expected_commands(const CLI::App& program) {
  std::vector<ExpectedCommand> commands;
  add_command(program, "", nullptr, commands);
  return commands;
}

}  // namespace morphbake::cli
