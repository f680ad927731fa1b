#pragma once

#include <vector>

#include "morphbake/mesh/mesh.h"

namespace morphbake {

/// The vertex that a point is nearest to: the corner with the largest barycentric coordinate.
int nearest_corner(const Mesh& mesh, const SurfacePoint& at);

/// Vertices as points of the surface.
///
/// @param vertices  each has a triangle
std::vector<SurfacePoint> vertex_points(const Mesh& mesh, const std::vector<int>& vertices);

/// Barycentric coordinates of the point of a triangle's plane that is closest to `position`; they
/// sum to 1 and are negative outside.
///
/// @param corners  a row a corner; they span an area
Eigen::Vector3d plane_coordinates(const Eigen::Matrix3d& corners, const Eigen::Vector3d& position);

}  // namespace morphbake
