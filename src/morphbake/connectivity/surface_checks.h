#pragma once

#include <utility>
#include <vector>

#include "morphbake/mesh/mesh.h"

namespace morphbake {

/// The largest distance of any point of `from` to `to`, too small by at most `error_bound`.
///
/// @see  CGAL bounded_error_Hausdorff_distance
double hausdorff_distance(const Mesh& from, const Mesh& to, double error_bound);

/// Pairs of triangles that meet elsewhere than at a common vertex or edge; triangles without area
/// count as well.
///
/// @param mesh  an oriented manifold
std::vector<std::pair<int, int>> self_intersections(const Mesh& mesh);

/// Marks the triangles that take part in self-intersections, and those that share a vertex with
/// one.
std::vector<char> triangles_near_cuts(const Mesh& mesh);

}  // namespace morphbake
