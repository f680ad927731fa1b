#include <fmt/core.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <filesystem>
#include <memory>
#include <optional>

#include "cli/commands.h"
#include "morphbake/bake/bake.h"
#include "morphbake/diagnostics/shown_text.h"
#include "morphbake/files/files.h"
#include "morphbake/recipe/read_recipe.h"

namespace morphbake::cli {
namespace {

struct Arguments {
  std::filesystem::path recipe;
  std::filesystem::path output_dir;
  std::vector<std::string> settings;
  bool with_previews = true;
  std::filesystem::path report;
  int threads = 0;
  std::optional<double> memory_limit;
  CacheArguments cache;
};

constexpr double kMostGigabytes = 1e6;  // as the schema of the options says

/// The first names; `inspect` lists them all.
std::string shown_names(const std::vector<std::string>& names) {
  constexpr std::size_t kShown = 12;
  const std::size_t count = std::min(names.size(), kShown);
  const std::vector<std::string> first(names.begin(),
                                       names.begin() + static_cast<std::ptrdiff_t>(count));
  return fmt::format("{}{}", fmt::join(first, ", "), count < names.size() ? ", ..." : "");
}

/// How the systems were solved, on one line.
std::string solve_line(const SolveReport& solve) {
  if (solve.solves.empty()) {
    return fmt::format("  nothing to solve; {} vertices held", solve.held);
  }
  int iterations = 0;
  double error = 0;
  for (const SolveRecord& record : solve.solves) {
    iterations += record.convergence.iterations;
    error = std::max(error, record.convergence.error);
  }
  return fmt::format("  {}: {} solves, {} iterations, error {:.1e}; {} vertices held{}",
                     solve.solver, solve.solves.size(), iterations, error, solve.held,
                     solve.solver == "pcg" ? " (" + solve.reason + ")" : "");
}

std::vector<std::string> summary_lines(const BakeReport& report) {
  std::vector<std::string> lines;
  double seconds = 0;
  for (const StageReport& stage : report.stages) seconds += stage.seconds;
  lines.push_back(fmt::format("{}: {} vertices, {} triangles, {} frames in {:.2f} s", report.recipe,
                              report.vertices, report.triangles, report.frames, seconds));
  lines.push_back(
      fmt::format("  {}: {}", report.solve.representation, report.solve.representation_reason));
  lines.push_back(solve_line(report.solve));
  for (const StageReport& stage : report.stages) {
    lines.push_back(fmt::format("  {:<14}{:8.2f} s", stage.name, stage.seconds));
  }
  if (!report.cached.empty()) {
    lines.push_back(fmt::format("  from the cache: {}", shown_names(report.cached)));
  }
  for (const OutputReport& output : report.outputs) {
    lines.push_back(fmt::format("  {}: {}", output.file.filename().string(),
                                shown_bytes(static_cast<double>(output.bytes))));
    if (output.targets.empty()) continue;
    lines.push_back(fmt::format("    {} targets ({}): {}", output.targets.size(), output.kind,
                                shown_names(output.targets)));
    lines.push_back(fmt::format(
        "    {} keys; error {:.1e} of the diagonal, normals {:.2f} degrees (99 in 100: {:.2f})",
        output.weight_keys, output.max_error, output.normals.maximum,
        output.normals.percentile_99));
  }
  return lines;
}

/// Fails now rather than after the bake when the report cannot be written, or would replace what
/// the bake reads or writes.
void check_report(const Recipe& recipe, const std::filesystem::path& file) {
  std::vector<std::filesystem::path> taken;
  for (const RecipePart& part : recipe.parts) taken.push_back(part.file);
  for (const SourceRef& source : recipe.sources) taken.push_back(source.file);
  for (const Output& output : recipe.outputs) taken.push_back(output.file);
  for (const std::filesystem::path& other : taken) {
    std::error_code error;
    const bool is_same = std::filesystem::absolute(file).lexically_normal() ==
                         std::filesystem::absolute(other).lexically_normal();
    if (!is_same && !std::filesystem::equivalent(file, other, error)) continue;
    throw usage_error("--report: '" + file.string() + "' is a file of the recipe",
                      "write the report to a file of its own");
  }
  PendingOutputs never_committed;
  never_committed.stage(file, "");
}

void run_bake(const Arguments& arguments, Terminal& terminal) {
  Recipe recipe = read_recipe(arguments.recipe);
  BakeOptions options =
      read_options(recipe.options, location_in(recipe, "/options").file, arguments.settings);
  options.threads = arguments.threads;
  if (arguments.memory_limit) options.solve.memory_limit = *arguments.memory_limit;
  if (!arguments.output_dir.empty()) {
    recipe = redirect_outputs(std::move(recipe), arguments.output_dir);
  }
  if (!arguments.with_previews) recipe.preview.reset();
  if (!arguments.report.empty()) check_report(recipe, arguments.report);

  const BakeReport report = bake(recipe, options, cache_of(arguments.cache), terminal.observer());
  for (const OutputReport& output : report.outputs) {
    terminal.result(output.file.string());
    for (const std::filesystem::path& preview : output.previews) terminal.result(preview.string());
  }
  if (!arguments.report.empty()) {
    PendingOutputs outputs;
    outputs.stage(arguments.report, report_to_json(report));
    outputs.commit();
    terminal.result(arguments.report.string());
  }
  terminal.report(report_to_json(report), summary_lines(report));
}

}  // namespace

Command add_bake(CLI::App& program) {
  auto arguments = std::make_shared<Arguments>();
  CLI::App* parser = program.add_subcommand("bake", "Bake a recipe; prints the files it wrote");
  parser->add_option("RECIPE", arguments->recipe, "A recipe (JSON)")->required();
  parser->add_option("-o,--output-dir", arguments->output_dir,
                     "Write all files into this folder instead of where the recipe says");
  add_settings(*parser, arguments->settings);
  add_preview_choice(*parser, arguments->with_previews);
  parser->add_option("--report", arguments->report, "Write what was done as JSON");
  parser
      ->add_option("--threads", arguments->threads, "0: all cores; changes the time, never a byte")
      ->check(CLI::Range(0, 1024))
      ->capture_default_str();
  parser
      ->add_option("--memory-limit", arguments->memory_limit,
                   "GB: morphs whose factor would take more are solved without; slower")
      ->check(number_in(0, kMostGigabytes));
  add_cache_options(*parser, arguments->cache);
  parser->footer(
      "\nExample: morphbake bake recipe.json --output-dir out --set /basis/easing_tolerance=1e-7");
  return {parser, [arguments](Terminal& terminal) { run_bake(*arguments, terminal); }};
}

}  // namespace morphbake::cli
