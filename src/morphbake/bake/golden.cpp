#include "morphbake/bake/golden.h"

#include <fmt/core.h>

#include <algorithm>
#include <set>
#include <utility>

#include "morphbake/bake/bake.h"
#include "morphbake/bake/diff_pictures.h"
#include "morphbake/bake/options.h"
#include "morphbake/files/distinct_names.h"
#include "morphbake/files/temporary_folder.h"
#include "morphbake/recipe/read_recipe.h"

namespace morphbake {
namespace {

namespace fs = std::filesystem;

constexpr std::uintmax_t kLargestFile = (std::uintmax_t{1} << 32) - 1;  // what a .glb can be

/// One recipe on its way.
struct GoldenRun {
  fs::path recipe;
  fs::path evidence;  ///< folder
  const GoldenOptions& options;
  const Observer& observer;
  std::set<fs::path>& claimed;  ///< golden files of all recipes so far
};

fs::path golden_file(const GoldenRun& run, const fs::path& output) {
  const fs::path& folder = run.options.golden_dir;
  return (folder.empty() ? run.recipe.parent_path() / "golden" : folder) / output.filename();
}

/// Two recipes whose results would be stored as one file would be compared with each other's.
///
/// @throws BakeError "recipe.duplicate-output"
void claim_golden_files(const GoldenRun& run, const Recipe& recipe) {
  std::vector<Problem> problems;
  for (std::size_t i = 0; i < recipe.outputs.size(); ++i) {
    const fs::path file = golden_file(run, recipe.outputs[i].file);
    if (run.claimed.insert(fs::absolute(file).lexically_normal()).second) continue;
    problems.push_back(
        {Severity::Error, "recipe.duplicate-output",
         location_in(recipe, fmt::format("/outputs/{}/file", i)),
         fmt::format("'{}' is the stored result of another output as well", file.string()),
         "run the recipes with a --golden-dir each, or give the outputs other names"});
  }
  if (!problems.empty()) throw BakeError(std::move(problems));
}

/// Leaves what shows a difference; a file that could not be compared leaves itself.
void leave_evidence(const GoldenRun& run, const fs::path& made, GoldenOutput& output) {
  PendingOutputs pending;
  output.evidence.push_back(run.evidence / output.name);
  if (output.difference) output.difference->file_b = output.evidence.back().string();
  pending.stage(output.evidence.back(), read_file(made, kLargestFile));
  if (output.difference) {
    const fs::path stem = run.evidence / fs::path(output.name).stem();
    DiffPictures pictures;
    pictures.heat_map = fs::path(stem) += ".heatmap.glb";
    for (const fs::path& picture :
         stage_diff_pictures(*output.difference, pictures, run.observer, pending)) {
      output.evidence.push_back(picture);
    }
    output.evidence.push_back(fs::path(stem) += ".diff.json");
    pending.stage(output.evidence.back(), difference_json(*output.difference));
  }
  pending.commit();
}

/// Compares a new file with the stored one.
void judge(const GoldenRun& run, const fs::path& made, GoldenOutput& output) {
  if (!fs::exists(output.golden)) {
    output.verdict = GoldenVerdict::Missing;
    return;
  }
  try {
    output.difference = diff_files(output.golden, made, run.options.diff, run.observer);
    output.difference->file_b = output.name;  // the temporary file is gone when this is read
    output.verdict = is_same(*output.difference) ? GoldenVerdict::Same : GoldenVerdict::Different;
  } catch (const BakeError& error) {
    output.verdict = GoldenVerdict::Failed;
    output.problems = error.problems();
  }
}

/// @param accepted  receives what is to be stored
GoldenOutput judged_output(const GoldenRun& run, const fs::path& made, PendingOutputs& accepted) {
  GoldenOutput output;
  output.name = made.filename().string();
  output.golden = golden_file(run, made);
  judge(run, made, output);
  if (output.verdict == GoldenVerdict::Same) return output;
  if (!run.options.accept) {
    leave_evidence(run, made, output);
    return output;
  }
  accepted.stage(output.golden, read_file(made, kLargestFile));
  output.verdict = GoldenVerdict::Accepted;
  return output;
}

GoldenRecipe run_recipe(const GoldenRun& run, PendingOutputs& accepted) {
  GoldenRecipe result;
  result.recipe = run.recipe.string();
  const TemporaryFolder folder("morphbake-golden");
  std::vector<fs::path> made;
  try {
    Recipe recipe = redirect_outputs(read_recipe(run.recipe), folder.path());
    claim_golden_files(run, recipe);
    recipe.preview.reset();
    BakeOptions options =
        read_options(recipe.options, location_in(recipe, "/options").file, run.options.settings);
    options.threads = run.options.diff.threads;
    for (const OutputReport& output : bake(recipe, options, {}, run.observer).outputs) {
      made.push_back(output.file);
    }
  } catch (const BakeError& error) {
    result.problems = error.problems();
    return result;
  }
  for (const fs::path& file : made) result.outputs.push_back(judged_output(run, file, accepted));
  return result;
}

/// A folder a recipe below that of all evidence: told apart by as much of the recipes' paths as it
/// takes, without the ending.
std::vector<fs::path> evidence_folders(const std::vector<fs::path>& recipes,
                                       const fs::path& below) {
  std::vector<fs::path> whole;
  for (const fs::path& recipe : recipes) {
    std::error_code error;
    const fs::path canonical = fs::weakly_canonical(recipe, error);
    whole.push_back(error ? recipe.lexically_normal() : canonical);
  }
  std::vector<fs::path> folders;
  for (const std::string& name : distinct_names(whole)) {
    folders.push_back(below / fs::path(name).replace_extension());
  }
  return folders;
}

bool is_bad(const GoldenOutput& output) {
  return output.verdict != GoldenVerdict::Same && output.verdict != GoldenVerdict::Accepted;
}

/// Takes back what was to be accepted.
void withdraw(std::vector<GoldenRecipe>& recipes) {
  for (GoldenRecipe& recipe : recipes) {
    for (GoldenOutput& output : recipe.outputs) {
      if (output.verdict != GoldenVerdict::Accepted) continue;
      output.verdict = output.difference         ? GoldenVerdict::Different
                       : output.problems.empty() ? GoldenVerdict::Missing
                                                 : GoldenVerdict::Failed;
    }
  }
}

}  // namespace

std::vector<GoldenRecipe> run_golden(const std::vector<fs::path>& recipes,
                                     const GoldenOptions& options, const Observer& observer) {
  const std::vector<fs::path> folders = evidence_folders(recipes, options.evidence_dir);
  std::vector<GoldenRecipe> results;
  PendingOutputs accepted;
  std::set<fs::path> claimed;
  for (std::size_t i = 0; i < recipes.size(); ++i) {
    results.push_back(run_recipe({recipes[i], folders[i], options, observer, claimed}, accepted));
  }
  if (has_failed(results)) {
    withdraw(results);
  } else {
    accepted.commit();
  }
  return results;
}

bool is_golden(const std::vector<GoldenRecipe>& recipes) {
  return std::ranges::none_of(recipes, [](const GoldenRecipe& recipe) {
    return !recipe.problems.empty() || std::ranges::any_of(recipe.outputs, is_bad);
  });
}

bool has_failed(const std::vector<GoldenRecipe>& recipes) {
  return std::ranges::any_of(recipes, [](const GoldenRecipe& recipe) {
    return !recipe.problems.empty() ||
           std::ranges::any_of(recipe.outputs, [](const GoldenOutput& output) {
             return output.verdict == GoldenVerdict::Failed;
           });
  });
}

}  // namespace morphbake
