#include "cli/commands.h"
#include "morphbake/bake/options.h"

namespace morphbake::cli {

Command add_config(CLI::App& program) {
  CLI::App* parser =
      program.add_subcommand("config", "Print every option with its default, as JSON");
  parser->footer("\nExample: morphbake config > options.json");
  return {parser, [](Terminal& terminal) {
            std::string text = options_to_json(BakeOptions{});
            while (!text.empty() && text.back() == '\n') text.pop_back();
            terminal.result(text);
          }};
}

}  // namespace morphbake::cli
