#pragma once

#include <memory>

#include "morphbake/bake/timeline_changes.h"
#include "morphbake/connectivity/morphable_mesh.h"
#include "morphbake/recipe/recipe.h"
#include "morphbake/solve/displacement_system.h"

namespace morphbake {

/// The displacement system of a timeline: what it holds and where the rest stands, as the recipe
/// says.
///
/// @throws BakeError "recipe.held-region-changes"
std::unique_ptr<DisplacementSystem> timeline_system(const Recipe& recipe, const MorphableMesh& mesh,
                                                    const RegionFields& regions,
                                                    const TimelineChanges& changes,
                                                    const SolveOptions& options);

}  // namespace morphbake
