// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

namespace shapes {
namespace {

/// Angle of triangle f at its given corner, radians.
double corner_angle(const Mesh& mesh, Eigen::Index f, int corner) {
  const auto at = [&](int c) -> Eigen::Vector3d {
    return mesh.positions.row(mesh.triangles(f, c % 3)).transpose();
  };
  const Eigen::Vector3d u = at(corner + 1) - at(corner);
  const Eigen::Vector3d v = at(corner + 2) - at(corner);
  return std::atan2(u.cross(v).norm(), u.dot(v));
}

}  // namespace

void round_to_float(Rows3d& rows) { rows = rows.cast<float>().cast<double>().eval(); }

void stand_on_floor(Mesh& mesh) {
  mesh.positions.col(1).array() -= mesh.positions.col(1).minCoeff();
  round_to_float(mesh.positions);
}

Rows3d vertex_normals(const Mesh& mesh) {
  Rows3d normals = Rows3d::Zero(mesh.positions.rows(), 3);
  for (Eigen::Index f = 0; f < mesh.triangles.rows(); ++f) {
    const Eigen::Vector3d a = mesh.positions.row(mesh.triangles(f, 0));
    const Eigen::Vector3d b = mesh.positions.row(mesh.triangles(f, 1));
    const Eigen::Vector3d c = mesh.positions.row(mesh.triangles(f, 2));
    const Eigen::Vector3d normal = (b - a).cross(c - a).normalized();
    for (int corner = 0; corner < 3; ++corner)
      normals.row(mesh.triangles(f, corner)) += corner_angle(mesh, f, corner) * normal.transpose();
  }
  normals.rowwise().normalize();
  return normals;
}

AngleReport angles(const Mesh& mesh) {
  AngleReport report{180, 0};
  for (Eigen::Index f = 0; f < mesh.triangles.rows(); ++f) {
    double smallest = 180;
    for (int corner = 0; corner < 3; ++corner)
      smallest = std::min(smallest, corner_angle(mesh, f, corner) * 180 / std::numbers::pi);
    report.smallest = std::min(report.smallest, smallest);
    if (smallest < 15) report.below_15 += 1.0 / static_cast<double>(mesh.triangles.rows());
  }
  return report;
}

}  // namespace shapes
