#include "morphbake/bake/places.h"

#include <utility>

#include "morphbake/recipe/places.h"
#include "morphbake/sources/places.h"

namespace morphbake {

Recipe with_positions(Recipe recipe, const std::vector<SourceMesh>& sources) {
  std::vector<Problem> problems;
  const auto settle = [&](Place& place, int on, const std::string& pointer, Whereabouts where) {
    const SourceMesh& source = sources[static_cast<std::size_t>(on)];
    try {
      const Location location = location_in(recipe, pointer);
      const Eigen::Vector3d position = scene_position(source, place, location);
      if (where == Whereabouts::OnSurface) check_near_surface(source, position, location);
      place = position;
    } catch (const BakeError& error) {
      problems.insert(problems.end(), error.problems().begin(), error.problems().end());
    }
  };
  visit_places(recipe, settle);
  if (!problems.empty()) throw BakeError(std::move(problems));
  return recipe;
}

}  // namespace morphbake
