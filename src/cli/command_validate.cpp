#include <fmt/core.h>

#include <filesystem>
#include <memory>

#include "cli/commands.h"
#include "morphbake/bake/bake.h"
#include "morphbake/recipe/read_recipe.h"

namespace morphbake::cli {

Command add_validate(CLI::App& program) {
  auto recipe_file = std::make_shared<std::filesystem::path>();
  CLI::App* parser = program.add_subcommand(
      "validate", "Check a recipe, its sources and their topology without baking");
  parser->add_option("RECIPE", *recipe_file, "A recipe (JSON)")->required();
  parser->footer("\nExample: morphbake validate recipe.json --log json");
  return {parser, [recipe_file](Terminal& terminal) {
            const Recipe recipe = read_recipe(*recipe_file);
            const BakeOptions options =
                read_options(recipe.options, location_in(recipe, "/options").file, {});
            validate(recipe, options, terminal.observer());
            terminal.result(fmt::format("{}: valid ({} sources, {} regions, {} outputs)",
                                        recipe_file->string(), recipe.sources.size(),
                                        recipe.regions.size(), recipe.outputs.size()));
          }};
}

}  // namespace morphbake::cli
