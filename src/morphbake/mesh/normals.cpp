#include "morphbake/mesh/normals.h"

#include <Eigen/Geometry>
#include <cmath>

namespace morphbake {

Normals corner_group_normals(const Positions& positions, const Triangles& triangles,
                             const std::vector<int>& corner_groups, int group_count) {
  Normals sums = Normals::Zero(group_count, 3);
  for (int f = 0; f < triangles.rows(); ++f) {
    Eigen::RowVector3d corners[3];
    for (int k = 0; k < 3; ++k) corners[k] = positions.row(triangles(f, k));
    const Eigen::RowVector3d area_normal = (corners[1] - corners[0]).cross(corners[2] - corners[0]);
    const double doubled_area = area_normal.norm();
    if (!(doubled_area > 0)) continue;
    for (int k = 0; k < 3; ++k) {
      const Eigen::RowVector3d u = corners[(k + 1) % 3] - corners[k];
      const Eigen::RowVector3d v = corners[(k + 2) % 3] - corners[k];
      const double angle = std::atan2(doubled_area, u.dot(v));
      sums.row(corner_groups[3 * static_cast<std::size_t>(f) + static_cast<std::size_t>(k)]) +=
          (angle / doubled_area) * area_normal;
    }
  }
  for (int g = 0; g < group_count; ++g) {
    const double length = sums.row(g).norm();
    if (length > 0) sums.row(g) /= length;
  }
  return sums;
}

Normals smooth_normals(const Positions& positions, const Triangles& triangles) {
  const std::vector<int> vertices(triangles.data(), triangles.data() + triangles.size());
  return corner_group_normals(positions, triangles, vertices, static_cast<int>(positions.rows()));
}

Eigen::Vector3d carry_normal(const Eigen::Vector3d& from, const Eigen::Vector3d& to,
                             const Eigen::Vector3d& normal) {
  const double cosine = from.dot(to);
  // Opposite directions have no unique least rotation: mirroring through the normal plane is as
  // good.
  if (cosine < -1 + 1e-12) return normal - 2 * normal.dot(from) * from;
  const Eigen::Vector3d axis = from.cross(to);
  return cosine * normal + axis.cross(normal) + axis * (axis.dot(normal) / (1 + cosine));
}

}  // namespace morphbake
