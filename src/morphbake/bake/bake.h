#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "morphbake/bake/options.h"
#include "morphbake/diagnostics/observer.h"
#include "morphbake/recipe/recipe.h"

namespace morphbake {

struct StageReport {
  std::string name;
  double seconds = 0;
};

struct OutputReport {
  std::filesystem::path file;
  std::size_t bytes = 0;
  std::vector<std::string> targets;
  int weight_keys = 0;
  double max_error =
      0;  ///< of the written positions at frames and middles, fraction of the diagonal
  double max_normal_error = 0;  ///< degrees
  std::vector<std::filesystem::path> previews;
};

/// What a bake did: --report writes it, schemas/report.schema.json describes it.
struct BakeReport {
  std::string recipe;
  int vertices = 0;  ///< of the shared connectivity
  int triangles = 0;
  int components = 0;
  int frames = 0;
  int solved_shapes = 0;  ///< right-hand sides that were solved
  std::vector<StageReport> stages;
  std::vector<OutputReport> outputs;
  std::vector<Problem> problems;  ///< warnings
};

std::string report_to_json(const BakeReport& report);

/// Bakes a recipe: one call a stage. All output files appear together at the end, or none.
///
/// @throws BakeError, Cancelled
BakeReport bake(const Recipe& recipe, const BakeOptions& options, const Observer& observer);

/// Checks names, sources, landmarks and topology without solving or writing.
///
/// @throws BakeError with all problems found
void validate(const Recipe& recipe, const Observer& observer);

/// Renders the turntable of any morph glTF.
///
/// @param outputs_stem  "dir/name": writes dir/name.gif, dir/name.sheet.png,
/// dir/name.frames/0000.png
/// @return              the files written
std::vector<std::filesystem::path> preview(const std::filesystem::path& gltf_file,
                                           const PreviewRequest& request,
                                           const TurntableOptions& options,
                                           const std::filesystem::path& outputs_stem,
                                           const Observer& observer);

}  // namespace morphbake
