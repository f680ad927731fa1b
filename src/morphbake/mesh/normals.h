#pragma once

#include <vector>

#include "morphbake/mesh/mesh.h"

namespace morphbake {

/// Sums of face normals weighted by corner angle, one a group of corners, normalised.
///
/// Groups say which corners share a normal: one group a vertex gives a smooth surface; corners
/// split at a hard edge fall into several.
/// @param corner_groups  3 #F group indices, corner 3 f + k; all in [0, group_count)
/// @return               #groups by 3; zero rows where every face of the group is degenerate
/// @see                  Thürmer and Wüthrich 1998, angle-weighted pseudo-normals
Normals corner_group_normals(const Positions& positions, const Triangles& triangles,
                             const std::vector<int>& corner_groups, int group_count);

/// One a vertex, as if the surface had no hard edge.
Normals smooth_normals(const Positions& positions, const Triangles& triangles);

/// The rotation of least angle that takes unit vector `from` to unit vector `to`, applied to
/// `normal`.
Eigen::Vector3d carry_normal(const Eigen::Vector3d& from, const Eigen::Vector3d& to,
                             const Eigen::Vector3d& normal);

}  // namespace morphbake
