#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "morphbake/diagnostics/observer.h"
#include "morphbake/diff/diff_options.h"
#include "morphbake/diff/file_difference.h"

namespace morphbake {

/// How recipes are run against stored results.
struct GoldenOptions {
  /// Where the stored results lie, one a output under its file name; empty: the folder "golden"
  /// beside each recipe.
  std::filesystem::path golden_dir = {};

  /// Where evidence of what is not as stored goes: a folder a recipe.
  std::filesystem::path evidence_dir = "golden-differences";

  bool accept = false;  ///< whether new results are stored: all of them, or none when a bake fails
  DiffOptions diff = {};
  std::vector<std::string> settings = {};  ///< as of read_options
};

enum class GoldenVerdict {
  Same,
  Different,
  Missing,   ///< nothing is stored
  Accepted,  ///< was different or missing, and is stored now
  Failed,    ///< the stored file cannot be read
};

/// One output of a recipe.
struct GoldenOutput {
  std::string name;              ///< of the file
  std::filesystem::path golden;  ///< where the stored result is, or is to be
  GoldenVerdict verdict = GoldenVerdict::Same;
  std::optional<FileDifference> difference;     ///< from the stored one, where that could be read
  std::vector<std::filesystem::path> evidence;  ///< the new file, a heat-map, what differs
  std::vector<Problem> problems;                ///< why the stored file cannot be read
};

/// One recipe.
struct GoldenRecipe {
  std::string recipe;  ///< as it was named
  std::vector<GoldenOutput> outputs;
  std::vector<Problem> problems;  ///< why it could not be baked; then it has no outputs
};

/// Bakes recipes without previews into a temporary folder and compares each output with the stored
/// one. What goes wrong with one recipe does not keep the others from being judged.
///
/// Of an output that is different or missing, the new file stays as evidence in the folder of its
/// recipe below `evidence_dir`, of a different one a heat-map and the JSON of what differs as well.
/// @throws BakeError "output.unwritable"; Cancelled, and then nothing is stored
std::vector<GoldenRecipe> run_golden(const std::vector<std::filesystem::path>& recipes,
                                     const GoldenOptions& options, const Observer& observer);

/// Whether all is as stored, or was stored now.
bool is_golden(const std::vector<GoldenRecipe>& recipes);

/// Whether something could not be judged.
bool has_failed(const std::vector<GoldenRecipe>& recipes);

/// As JSON text: schemas/golden.schema.json.
std::string golden_json(const std::vector<GoldenRecipe>& recipes);

/// As JUnit's XML: a suite a recipe, a case an output. Without times, so that equal results are
/// equal bytes; what XML cannot hold becomes U+FFFD.
std::string golden_junit(const std::vector<GoldenRecipe>& recipes);

}  // namespace morphbake
