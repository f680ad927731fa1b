#include <fmt/core.h>

#include <memory>

#include "cli/commands.h"
#include "morphbake/bake/plan.h"
#include "morphbake/recipe/read_recipe.h"

namespace morphbake::cli {
namespace {

struct Arguments {
  std::filesystem::path recipe;
  std::vector<std::string> settings;
  CacheArguments cache;
  bool with_previews = true;
  bool explain = false;
  bool json = false;
};

constexpr const char* kWords[] = {"cached", "runs", "not needed"};

std::string line_of(const PlannedStage& stage, bool explain) {
  const std::string seconds = stage.seconds ? fmt::format("{:9.2f} s", *stage.seconds) : "";
  std::string line =
      fmt::format("{:<11}{:<11} {}", kWords[static_cast<int>(stage.state)], seconds, stage.name);
  if (explain && !stage.reason.empty()) line += ": " + stage.reason;
  return line;
}

void run_plan(const Arguments& arguments, Terminal& terminal) {
  Recipe recipe = read_recipe(arguments.recipe);
  if (!arguments.with_previews) recipe.preview.reset();
  const BakeOptions options =
      read_options(recipe.options, location_in(recipe, "/options").file, arguments.settings);
  const StageCache cache = cache_of(arguments.cache);
  const Observer observer = terminal.observer();
  const std::vector<PlannedStage> stages =
      plan(recipe, options, BakeCache(cache, recipe, observer));
  if (arguments.json) {
    terminal.result(plan_to_json(stages));
    return;
  }
  for (const PlannedStage& stage : stages) terminal.result(line_of(stage, arguments.explain));
}

}  // namespace

Command add_plan(CLI::App& program) {
  auto arguments = std::make_shared<Arguments>();
  CLI::App* parser =
      program.add_subcommand("plan", "Tell which stages a bake would run, and which it has");
  parser->add_option("RECIPE", arguments->recipe, "A recipe (JSON)")->required();
  parser->add_flag("--explain", arguments->explain, "Say why each stage runs: what changed");
  parser->add_flag("--json", arguments->json, "Print a JSON array instead");
  add_settings(*parser, arguments->settings);
  add_preview_choice(*parser, arguments->with_previews);
  add_cache_options(*parser, arguments->cache);
  parser->footer(
      "\nSeconds are those that the stage took when it ran last.\n"
      "Example: morphbake plan recipe.json --explain");
  return {parser, [arguments](Terminal& terminal) { run_plan(*arguments, terminal); }};
}

}  // namespace morphbake::cli
