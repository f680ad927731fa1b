#pragma once

#include <memory>
#include <vector>

#include "morphbake/bake/bake.h"
#include "morphbake/bake/bake_cache.h"
#include "morphbake/bake/solved_recipe.h"
#include "morphbake/bake/stage_clock.h"

namespace morphbake {

/// All that stages before the outputs made, of which those are made.
struct SolvedStages {
  Recipe recipe;  ///< where its sources are, with shapes that were fitted
  std::vector<SourceMesh> sources;
  ConnectivityReport connectivity;
  MorphableMesh mesh;
  RegionFields regions;
  std::unique_ptr<SolvedTimeline> timeline;
  SmoothingGroups groups;
  ShapeColours colours;
  std::vector<Problem> warnings;
  Observer observer;  ///< which the timeline asks as long as it is there

  SolvedRecipe view() const {
    return {recipe, sources.front(), mesh, regions, *timeline, groups, colours};
  }
};

/// Runs the stages from the sources to the solved timeline, each of which takes from the cache what
/// it has.
///
/// @return  refers to itself, so it stays where it is
/// @throws  BakeError, Cancelled
std::unique_ptr<SolvedStages> solve_recipe(const Recipe& recipe, const BakeOptions& options,
                                           const StageContext& context, StageClock& clock);

/// Finds what solve_recipe would refuse before it solves.
void check_recipe(const Recipe& recipe, const BakeOptions& options, const Observer& observer);

}  // namespace morphbake
