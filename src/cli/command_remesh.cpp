#include <fmt/core.h>

#include <filesystem>
#include <memory>

#include "cli/commands.h"
#include "morphbake/bake/remesh.h"
#include "morphbake/files/files.h"
#include "morphbake/recipe/read_recipe.h"

namespace morphbake::cli {
namespace {

struct Arguments {
  std::filesystem::path recipe;
  std::filesystem::path output_dir = "connectivity";
  std::vector<std::string> settings;
  std::string sheet = "png";
  std::filesystem::path report;
  int threads = 0;
};

std::vector<std::string> summary_lines(const RemeshReport& report) {
  std::vector<std::string> lines;
  const ConnectivityReport& connectivity = report.connectivity;
  double seconds = 0;
  for (const StageReport& step : connectivity.steps) seconds += step.seconds;
  lines.push_back(fmt::format("{}: {} vertices, {} triangles in {:.2f} s", report.recipe,
                              connectivity.vertices, connectivity.triangles, seconds));
  if (const auto& texture = connectivity.texture) {
    lines.push_back(fmt::format("  texture: {} x {} texels, {} charts cover {:.0f} %",
                                texture->size, texture->size, texture->charts,
                                100 * texture->covered));
  }
  for (const SourceQuality& source : connectivity.quality->sources) {
    lines.push_back(
        fmt::format("  {}: {:.2g} / {:.2g} of the diagonal from it / to it, {} folds, {} new "
                    "self-intersections, "
                    "smallest angle {:.1f} degrees",
                    source.source, source.source_to_remesh, source.remesh_to_source, source.folds,
                    source.new_self_intersections, source.smallest_angle));
  }
  for (const MapQuality& map : connectivity.quality->maps) {
    lines.push_back(fmt::format(
        "  distortion to {}: mean {:.3f}, median {:.3f}, 99 in 100 {:.2f}, worst {:.3g}",
        map.source, map.mean, map.median, map.percentile_99, map.maximum));
  }
  for (const StageReport& step : connectivity.steps) {
    lines.push_back(fmt::format("  {:<14}{:8.2f} s", step.name, step.seconds));
  }
  return lines;
}

/// Fails now rather than after the work when the report would replace a file of the recipe.
void check_report(const Recipe& recipe, const Arguments& arguments, SheetRequest sheet) {
  std::vector<std::filesystem::path> taken = remeshed_files(recipe, arguments.output_dir, sheet);
  for (const RecipePart& part : recipe.parts) taken.push_back(part.file);
  for (const SourceRef& source : recipe.sources) taken.push_back(source.file);
  for (const std::filesystem::path& other : taken) {
    std::error_code error;
    const bool is_same = std::filesystem::absolute(arguments.report).lexically_normal() ==
                         std::filesystem::absolute(other).lexically_normal();
    if (!is_same && !std::filesystem::equivalent(arguments.report, other, error)) continue;
    throw usage_error("--report: '" + arguments.report.string() + "' is a file of the recipe",
                      "write the report to a file of its own");
  }
  PendingOutputs never_committed;
  never_committed.stage(arguments.report, "");
}

void run_remesh(const Arguments& arguments, Terminal& terminal) {
  const Recipe recipe = read_recipe(arguments.recipe);
  BakeOptions options =
      read_options(recipe.options, location_in(recipe, "/options").file, arguments.settings);
  options.threads = arguments.threads;
  const SheetRequest sheet = arguments.sheet == "none" ? SheetRequest::None : SheetRequest::Make;
  if (!arguments.report.empty()) check_report(recipe, arguments, sheet);
  const RemeshReport report =
      remesh(recipe, options, arguments.output_dir, sheet, terminal.observer());
  for (const std::filesystem::path& file : report.files) terminal.result(file.string());
  if (!arguments.report.empty()) {
    PendingOutputs outputs;
    outputs.stage(arguments.report, report_to_json(report));
    outputs.commit();
    terminal.result(arguments.report.string());
  }
  terminal.report(report_to_json(report), summary_lines(report));
}

}  // namespace

Command add_remesh(CLI::App& program) {
  auto arguments = std::make_shared<Arguments>();
  CLI::App* parser = program.add_subcommand(
      "remesh", "Write a recipe's sources on one new connectivity; prints the files it wrote");
  parser->add_option("RECIPE", arguments->recipe, "A recipe (JSON) with a connectivity mode")
      ->required();
  parser->add_option("-o,--output-dir", arguments->output_dir, "Folder of the new files")
      ->capture_default_str();
  add_settings(*parser, arguments->settings);
  parser->add_option("--sheet", arguments->sheet, "`none` leaves the picture out")
      ->check(CLI::IsMember({"png", "none"}))
      ->capture_default_str();
  parser->add_option("--report", arguments->report, "Write what was measured as JSON");
  parser
      ->add_option("--threads", arguments->threads, "0: all cores; changes the time, never a byte")
      ->check(CLI::Range(0, 1024))
      ->capture_default_str();
  parser->footer(
      "\nWrites SOURCE.glb for each source (same vertices, same triangles), NAME.maps.bin (where\n"
      "each vertex lies on each source) and NAME.connectivity.png. Recipes of the mode \"shared\"\n"
      "can start from the new files.\n"
      "\nExample: morphbake remesh recipe.json -o connectivity --report connectivity/report.json");
  return {parser, [arguments](Terminal& terminal) { run_remesh(*arguments, terminal); }};
}

}  // namespace morphbake::cli
