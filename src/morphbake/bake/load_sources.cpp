#include "morphbake/bake/load_sources.h"

#include <utility>

#include "morphbake/bake/places.h"

namespace morphbake {

std::vector<SourceMesh> load_sources(const Recipe& recipe, const Observer& observer) {
  std::vector<SourceMesh> sources;
  std::vector<Problem> problems;
  const auto count = static_cast<int>(recipe.sources.size());
  for (int s = 0; s < count; ++s) {
    advance(observer, {"sources", s, count});
    try {
      sources.push_back(load_source(recipe.sources[static_cast<std::size_t>(s)]));
    } catch (const BakeError& error) {
      problems.insert(problems.end(), error.problems().begin(), error.problems().end());
    }
  }
  if (!problems.empty()) throw BakeError(problems);
  return sources;
}

AlignedSources load_aligned(const Recipe& recipe, const Observer& observer) {
  std::vector<SourceMesh> loaded = load_sources(recipe, observer);
  Recipe placed = with_positions(recipe, loaded);
  return align_sources(std::move(placed), std::move(loaded), observer);
}

Observer recording(const Observer& observer, std::vector<Problem>& problems) {
  Observer both = observer;
  both.on_problem = [&observer, &problems](const Problem& problem) {
    problems.push_back(problem);
    report(observer, problem);
  };
  return both;
}

}  // namespace morphbake
