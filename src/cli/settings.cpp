#include <fmt/core.h>

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

CLI::Validator number_in(double least, double most) {
  return CLI::Validator(
      [least, most](const std::string& text) -> std::string {
        double number = 0;
        const bool is_number = CLI::detail::lexical_cast(text, number);
        if (is_number && number >= least && number <= most) return "";
        return fmt::format("'{}' is no number from {} to {}", text, least, most);
      },
      "NUMBER");
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
