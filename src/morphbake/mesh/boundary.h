#pragma once

#include <map>
#include <vector>

#include "morphbake/mesh/mesh.h"

namespace morphbake {

/// Where the boundary edge of each boundary vertex leads, in the direction of the triangles.
///
/// @param triangles  of an oriented manifold
std::map<int, int> boundary_edges(const Triangles& triangles);

/// The vertices of each boundary loop, in the direction of the triangles.
std::vector<std::vector<int>> boundary_loops(const Triangles& triangles);

/// The vertices of the longest boundary loop of an oriented manifold, in the direction of its
/// triangles; none of a closed surface.
std::vector<int> longest_boundary(const Mesh& mesh);

}  // namespace morphbake
