#pragma once

#include <vector>

#include "morphbake/mesh/mesh.h"

namespace morphbake {

/// The vertices of the longest boundary loop of an oriented manifold, in the direction of its
/// triangles; none of a closed surface.
std::vector<int> longest_boundary(const Mesh& mesh);

}  // namespace morphbake
