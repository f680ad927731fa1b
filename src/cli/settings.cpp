#include <charconv>

#include "cli/commands.h"

namespace morphbake::cli {

void add_settings(CLI::App& parser, std::vector<std::string>& settings) {
  parser
      .add_option(
          "--set", settings,
          "Override an option by its JSON pointer; may be repeated (names: morphbake config)")
      ->type_name("/POINTER=VALUE")
      ->allow_extra_args(false);
}

void add_node(CLI::App& parser, std::string& node) {
  parser.add_option("--node", node,
                    "The node whose mesh is meant, by its name in the file or its index from 0 "
                    "(default: the first one with a mesh)");
}

NameOrIndex name_or_index(const std::string& text) {
  if (text.empty()) return {};
  int index = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), index);
  if (error == std::errc() && end == text.data() + text.size()) return index;
  return text;
}

}  // namespace morphbake::cli
