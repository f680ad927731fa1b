#include <fmt/core.h>

#include <filesystem>
#include <memory>

#include "cli/commands.h"
#include "cli/difference_text.h"
#include "morphbake/bake/golden.h"
#include "morphbake/files/files.h"

namespace morphbake::cli {
namespace {

namespace fs = std::filesystem;

constexpr const char* kFooter = R"(
Golden files are results that somebody has looked at and accepted. `golden` bakes each recipe anew,
into a temporary folder, and compares each output with the file of its name in the folder "golden"
beside the recipe (or --golden-dir) as `morphbake diff` does. Nothing is stored but by --accept, and
then all new results or, when a bake fails, none. Of what is different or missing the new file, a
heat-map and the differences as JSON stay in a folder that is told (--evidence-dir).

Exit codes: 0 as stored (or accepted), 1 different or missing, 2 an error. Page: docs/diff.md

Example: morphbake golden recipe.json
         morphbake golden recipe.json --accept
         morphbake golden morphs/*.json --golden-dir accepted --junit golden.xml)";

struct Arguments {
  std::vector<fs::path> recipes;
  GoldenOptions options;
  fs::path junit;
  bool json = false;
};

std::string line_of(const GoldenOutput& output) {
  switch (output.verdict) {
    case GoldenVerdict::Same:
      return fmt::format("same       {}", output.golden.string());
    case GoldenVerdict::Different:
      return fmt::format("different  {}", output.golden.string());
    case GoldenVerdict::Missing:
      return fmt::format("missing    {}: --accept stores it", output.golden.string());
    case GoldenVerdict::Accepted:
      return fmt::format("accepted   {}", output.golden.string());
    case GoldenVerdict::Failed:
      break;
  }
  return fmt::format("failed     {}", output.golden.string());
}

void tell_output(const GoldenOutput& output, Terminal& terminal) {
  terminal.result(line_of(output));
  if (output.verdict == GoldenVerdict::Different) {
    for (const std::string& line : difference_lines(*output.difference)) {
      terminal.result("  " + line);
    }
  }
  if (!output.evidence.empty()) {
    terminal.result("  evidence    " + output.evidence.front().parent_path().string());
  }
}

void tell(const std::vector<GoldenRecipe>& recipes, Terminal& terminal) {
  for (const GoldenRecipe& recipe : recipes) {
    terminal.result(recipe.recipe);
    if (!recipe.problems.empty()) terminal.result("failed     cannot be baked");
    for (const GoldenOutput& output : recipe.outputs) tell_output(output, terminal);
  }
}

/// Fails now rather than after the bakes when a file cannot be written.
void check_writable(const fs::path& file) {
  if (file.empty()) return;
  PendingOutputs never_committed;
  never_committed.stage(file, "");
}

/// All problems that kept recipes from being judged.
std::vector<Problem> problems_of(const std::vector<GoldenRecipe>& recipes) {
  std::vector<Problem> problems;
  const auto add = [&](const std::vector<Problem>& more) {
    problems.insert(problems.end(), more.begin(), more.end());
  };
  for (const GoldenRecipe& recipe : recipes) {
    add(recipe.problems);
    for (const GoldenOutput& output : recipe.outputs) {
      if (output.verdict == GoldenVerdict::Failed) add(output.problems);
    }
  }
  return problems;
}

bool judge_recipes(const Arguments& arguments, Terminal& terminal) {
  check_writable(arguments.junit);
  const std::vector<GoldenRecipe> recipes =
      run_golden(arguments.recipes, arguments.options, terminal.observer());
  if (!arguments.junit.empty()) {
    PendingOutputs outputs;
    outputs.stage(arguments.junit, golden_junit(recipes));
    outputs.commit();
  }
  arguments.json ? terminal.result(golden_json(recipes)) : tell(recipes, terminal);
  if (has_failed(recipes)) throw BakeError(problems_of(recipes));
  return is_golden(recipes);
}

}  // namespace

Command add_golden(CLI::App& program) {
  auto arguments = std::make_shared<Arguments>();
  CLI::App* parser = program.add_subcommand(
      "golden", "Bake recipes and compare the results with stored ones; --accept stores new ones");
  parser->add_option("RECIPE", arguments->recipes, "One or more recipes (JSON)")->required();
  GoldenOptions& options = arguments->options;
  parser->add_flag("--accept", options.accept, "Store results that are different or missing");
  parser->add_option("--golden-dir", options.golden_dir,
                     "Where the stored results are (default: \"golden\" beside each recipe)");
  parser
      ->add_option("--evidence-dir", options.evidence_dir,
                   "Where evidence of differences goes, a folder a recipe")
      ->capture_default_str();
  parser->add_option("--junit", arguments->junit, "Write the verdicts as JUnit's XML");
  parser->add_flag("--json", arguments->json, "The verdicts as JSON (schemas/golden.schema.json)");
  add_tolerances(*parser, options.diff);
  add_settings(*parser, options.settings);
  parser->footer(kFooter);
  return {
      parser, {}, [arguments](Terminal& terminal) { return judge_recipes(*arguments, terminal); }};
}

}  // namespace morphbake::cli
