#pragma once

#include <vector>

#include "morphbake/connectivity/morphable_mesh.h"
#include "morphbake/recipe/recipe.h"

namespace morphbake {

/// d of every region: 0 inside, 1 outside, between them across the soft ring.
///
/// A ball is measured on the geometry of the source that it names and carried to K vertex by
/// vertex.
/// @param recipe  whose balls have positions for centres (see with_positions)
/// @return  one a region: #V, each in [0, 1]
/// @see     Alexa 2003, section 5.1
std::vector<Eigen::VectorXd> region_distances(const MorphableMesh& mesh, const Recipe& recipe);

}  // namespace morphbake
