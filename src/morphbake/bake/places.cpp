#include "morphbake/bake/places.h"

#include <utility>

#include "morphbake/recipe/places.h"
#include "morphbake/sources/places.h"

namespace morphbake {

Recipe with_positions(Recipe recipe, const std::vector<SourceMesh>& sources) {
  std::vector<Problem> problems;
  const auto settle = [&](Place& place, int source, const std::string& pointer) {
    try {
      place = scene_position(sources[static_cast<std::size_t>(source)], place,
                             location_in(recipe, pointer));
    } catch (const BakeError& error) {
      problems.insert(problems.end(), error.problems().begin(), error.problems().end());
    }
  };
  visit_places(recipe, settle);
  if (!problems.empty()) throw BakeError(std::move(problems));
  return recipe;
}

}  // namespace morphbake
