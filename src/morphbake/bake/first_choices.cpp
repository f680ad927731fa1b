#include "morphbake/bake/first_choices.h"

#include <fmt/core.h>

#include <algorithm>
#include <utility>

#include "morphbake/bake/load_sources.h"
#include "morphbake/connectivity/morphable_mesh.h"
#include "morphbake/sources/align_sources.h"
#include "morphbake/sources/common_landmarks.h"

namespace morphbake {
namespace {

bool is_about_different_triangles(const Problem& problem) {
  return problem.code == "connectivity.different-triangles" ||
         problem.code == "connectivity.different-topology";
}

bool share_their_triangles(const std::vector<SourceMesh>& sources) {
  try {
    share_connectivity(sources);
    return true;
  } catch (const BakeError& error) {
    // Sources that are wrong by themselves are no choice.
    const auto& problems = error.problems();
    if (!std::all_of(problems.begin(), problems.end(), is_about_different_triangles)) throw;
    return false;
  }
}

/// A file's name as a shell takes it.
std::string in_shell(const std::string& file) {
  constexpr const char* kPlain =
      "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789/._-+,=@%";
  if (!file.empty() && file.find_first_not_of(kPlain) == std::string::npos) return file;
  std::string quoted = "'";
  for (const char letter : file) quoted += letter == '\'' ? "'\\''" : std::string(1, letter);
  return quoted + "'";
}

Problem too_few_landmarks(const std::vector<SourceRef>& sources, std::size_t common) {
  const bool has_some = std::any_of(sources.begin(), sources.end(),
                                    [](const auto& source) { return !source.landmarks.empty(); });
  const std::string command =
      fmt::format("morphbake landmarks suggest {} {}{}", in_shell(sources[0].file.string()),
                  in_shell(sources[1].file.string()), has_some ? " --force" : "");
  std::string hint = fmt::format("`{}` proposes some", command);
  if (has_some) hint += " in place of those beside the files; or name the same points on all";
  if (sources.size() > 2) hint += "; the other sources need points of the same names by hand";
  return {
      Severity::Error,
      "landmarks.too-few",
      {sources[0].file.string(), ""},
      fmt::format("the sources do not share their triangles, so they need new ones by landmarks; "
                  "they have {} in common, and {} are needed",
                  common, kFewestLandmarks),
      std::move(hint)};
}

}  // namespace

FirstChoices first_choices(const Recipe& draft, const Observer& observer) {
  const std::vector<SourceMesh> sources = load_sources(draft, observer);
  FirstChoices choices;
  if (share_their_triangles(sources)) return choices;
  choices.remesh = true;
  const std::size_t common = common_landmark_names(draft.sources).size();
  if (common < kFewestLandmarks) throw BakeError(too_few_landmarks(draft.sources, common));
  for (const SourceMesh& source : sources) {
    choices.is_unlike.push_back(is_unlike(sources.front(), source));
  }
  return choices;
}

}  // namespace morphbake
