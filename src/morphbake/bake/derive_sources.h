#pragma once

#include "morphbake/connectivity/morphable_mesh.h"
#include "morphbake/diagnostics/observer.h"
#include "morphbake/recipe/recipe.h"
#include "morphbake/transition/region_fields.h"

namespace morphbake {

/// Adds the geometries of all derived sources, each made from one that is there already.
///
/// @param recipe  whose places are positions (see with_positions)
/// @param mesh    has one geometry a source with a file
/// @throws BakeError "derive....", "linear.no-eigenvectors", "recipe.moving-region" for an edit's
///         region, "recipe.empty-handle"; Cancelled
void derive_sources(const Recipe& recipe, const RegionFields& regions, MorphableMesh& mesh,
                    const Observer& observer);

}  // namespace morphbake
