#include "morphbake/mesh/measures.h"

#include <Eigen/Geometry>
#include <cmath>

namespace morphbake {

double bounding_diagonal(const Positions& positions) {
  if (positions.rows() == 0) return 0;
  return (positions.colwise().maxCoeff() - positions.colwise().minCoeff()).norm();
}

Eigen::VectorXd triangle_areas(const Positions& positions, const Triangles& triangles) {
  Eigen::VectorXd areas(triangles.rows());
  for (int f = 0; f < triangles.rows(); ++f) {
    const Eigen::RowVector3d a = positions.row(triangles(f, 0));
    const Eigen::RowVector3d ab = positions.row(triangles(f, 1)) - a;
    const Eigen::RowVector3d ac = positions.row(triangles(f, 2)) - a;
    areas(f) = ab.cross(ac).norm() / 2;
  }
  return areas;
}

std::vector<int> triangles_with_area(const Positions& positions, const Triangles& triangles) {
  std::vector<int> proper;
  for (int f = 0; f < triangles.rows(); ++f) {
    const auto corner = [&](int k) -> Eigen::RowVector3d { return positions.row(triangles(f, k)); };
    if ((corner(1) - corner(0)).cross(corner(2) - corner(0)).norm() > 0) proper.push_back(f);
  }
  return proper;
}

Eigen::VectorXd vertex_areas(const Positions& positions, const Triangles& triangles) {
  const Eigen::VectorXd thirds = triangle_areas(positions, triangles) / 3;
  Eigen::VectorXd areas = Eigen::VectorXd::Zero(positions.rows());
  for (int f = 0; f < triangles.rows(); ++f) {
    for (int k = 0; k < 3; ++k) areas(triangles(f, k)) += thirds(f);
  }
  return areas;
}

double enclosed_volume(const Positions& positions, const Triangles& triangles) {
  if (triangles.rows() == 0) return 0;
  // From a point of the surface: from a far origin, large tetrahedra would cancel each other.
  const Eigen::RowVector3d tip = positions.row(triangles(0, 0));
  double six_fold = 0;
  for (int f = 0; f < triangles.rows(); ++f) {
    const Eigen::RowVector3d a = positions.row(triangles(f, 0)) - tip;
    const Eigen::RowVector3d b = positions.row(triangles(f, 1)) - tip;
    const Eigen::RowVector3d c = positions.row(triangles(f, 2)) - tip;
    six_fold += a.dot(b.cross(c));
  }
  return six_fold / 6;
}

double largest_distance(const Positions& a, const Positions& b) {
  if (a.rows() == 0) return 0;
  return std::sqrt((a - b).rowwise().squaredNorm().maxCoeff());
}

}  // namespace morphbake
