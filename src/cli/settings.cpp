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

}  // namespace morphbake::cli
