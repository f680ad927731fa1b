#pragma once

#include <optional>
#include <vector>

#include "morphbake/connectivity/morphable_mesh.h"
#include "morphbake/recipe/recipe.h"
#include "morphbake/transition/region_fields.h"

namespace morphbake {

/// All regions of a recipe on K.
///
/// Each is measured on the geometry of the source that it names and carried to K vertex by vertex.
/// Geodesic distances share a factorisation a source and piece of its surface.
/// @param recipe  whose places are positions (see with_positions)
/// @param masks   one a region: what mask_values gave, or no rows
/// @param known   one a region, or none: fields that are not made again
/// @throws BakeError "transition.distance-failed", "recipe.ring", "recipe.unreached",
///         "recipe.expression"
/// @see    Alexa 2003, sections 2.4, 5.1 to 5.3
RegionFields region_fields(const MorphableMesh& mesh, const Recipe& recipe,
                           const std::vector<Eigen::VectorXd>& masks = {},
                           std::vector<std::optional<RegionField>> known = {});

}  // namespace morphbake
