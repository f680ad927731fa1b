#include "morphbake/bake/places.h"

#include <utility>

#include "morphbake/json/json.h"
#include "morphbake/sources/places.h"

namespace morphbake {

Recipe with_positions(Recipe recipe, const std::vector<SourceMesh>& sources) {
  std::vector<Problem> problems;
  const auto settle = [&](Place& place, int source, const std::string& pointer) {
    try {
      place = scene_position(sources[static_cast<std::size_t>(source)], place,
                             {recipe.file.string(), pointer});
    } catch (const BakeError& error) {
      problems.insert(problems.end(), error.problems().begin(), error.problems().end());
    }
  };
  for (RegionOfInterest& region : recipe.regions) {
    auto* ball = std::get_if<BallRegion>(&region.shape);
    if (ball == nullptr) continue;
    settle(ball->centre, ball->source, child_pointer("/regions", region.name) + "/ball/at");
  }
  if (recipe.gauge.kind == Gauge::Kind::Landmark) {
    settle(recipe.gauge.at, recipe.gauge.source, "/gauge/landmark/at");
  } else if (recipe.gauge.kind == Gauge::Kind::Anchor) {
    settle(recipe.gauge.at, recipe.gauge.source, "/gauge/anchor/at");
  }
  if (!problems.empty()) throw BakeError(std::move(problems));
  return recipe;
}

}  // namespace morphbake
