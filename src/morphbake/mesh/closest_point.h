#pragma once

#include <vector>

#include "morphbake/diagnostics/observer.h"
#include "morphbake/mesh/mesh.h"

namespace morphbake {

/// Where a point of a mesh lies in space.
Eigen::Vector3d position_of(const Mesh& mesh, const SurfacePoint& at);

/// Barycentric coordinates of a point of a triangle: the shares of area across from each corner.
Eigen::Vector3d coordinates_in(const Mesh& mesh, int triangle, const Eigen::Vector3d& point);

/// The point of the surface that is closest to `position`.
///
/// @param mesh  with a triangle
/// @cost        O(#F log #F) for the search tree
SurfacePoint closest_point(const Mesh& mesh, const Eigen::Vector3d& position);

/// The closest point of the surface to each row of `positions`: one search tree for all.
///
/// @throws Cancelled
std::vector<SurfacePoint> closest_points(const Mesh& mesh, const Positions& positions,
                                         const Observer& observer = {});

}  // namespace morphbake
