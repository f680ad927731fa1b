#include "morphbake/mesh/surface_point.h"

#include <Eigen/Geometry>
#include <utility>

namespace morphbake {

int nearest_corner(const Mesh& mesh, const SurfacePoint& at) {
  Eigen::Index largest = 0;
  at.barycentric.maxCoeff(&largest);
  return mesh.triangles(at.triangle, largest);
}

std::vector<SurfacePoint> vertex_points(const Mesh& mesh, const std::vector<int>& vertices) {
  std::vector<SurfacePoint> first(static_cast<std::size_t>(mesh.positions.rows()), {-1, {}});
  for (int f = 0; f < mesh.triangles.rows(); ++f) {
    for (int k = 0; k < 3; ++k) {
      SurfacePoint& corner = first[static_cast<std::size_t>(mesh.triangles(f, k))];
      if (corner.triangle < 0) corner = {f, Eigen::Vector3d::Unit(k)};
    }
  }
  std::vector<SurfacePoint> points;
  points.reserve(vertices.size());
  for (const int vertex : vertices) points.push_back(first[static_cast<std::size_t>(vertex)]);
  return points;
}

Eigen::Vector3d plane_coordinates(const Eigen::Matrix3d& corners, const Eigen::Vector3d& position) {
  const Eigen::Vector3d a = corners.row(0), b = corners.row(1), c = corners.row(2);
  const Eigen::Vector3d normal = (b - a).cross(c - a);
  const auto share = [&](const Eigen::Vector3d& from, const Eigen::Vector3d& to) {
    return normal.dot((to - from).cross(position - from)) / normal.squaredNorm();
  };
  return {share(b, c), share(c, a), share(a, b)};
}

}  // namespace morphbake
