#include "morphbake/mesh/closest_point.h"

#include <CGAL/AABB_traits.h>
#include <CGAL/AABB_tree.h>
#include <CGAL/AABB_triangle_primitive.h>
#include <CGAL/Simple_cartesian.h>

#include <Eigen/Geometry>
#include <algorithm>

namespace morphbake {
namespace {

using Kernel = CGAL::Simple_cartesian<double>;
using Point = Kernel::Point_3;
using Triangle = Kernel::Triangle_3;
using Iterator = std::vector<Triangle>::const_iterator;
using Primitive = CGAL::AABB_triangle_primitive<Kernel, Iterator>;
constexpr Eigen::Index kStride = 1024;  // points between two looks whether to stop

using Tree = CGAL::AABB_tree<CGAL::AABB_traits<Kernel, Primitive>>;

std::vector<Triangle> triangles_of(const Mesh& mesh) {
  std::vector<Triangle> triangles;
  triangles.reserve(static_cast<std::size_t>(mesh.triangles.rows()));
  for (Eigen::Index f = 0; f < mesh.triangles.rows(); ++f) {
    const auto corner = [&](int k) {
      const int v = mesh.triangles(f, k);
      return Point(mesh.positions(v, 0), mesh.positions(v, 1), mesh.positions(v, 2));
    };
    triangles.emplace_back(corner(0), corner(1), corner(2));
  }
  return triangles;
}

/// Points of the surface from which a search may start: first corners, each place once. CGAL's own
/// choice takes one a triangle, and its tree of them never ends where thousands are the same.
std::vector<Tree::Point_and_primitive_id> starts_of(const std::vector<Triangle>& triangles) {
  std::vector<Iterator> order;
  order.reserve(triangles.size());
  for (auto triangle = triangles.begin(); triangle != triangles.end(); ++triangle) {
    order.push_back(triangle);
  }
  const auto corner = [](Iterator triangle) { return triangle->vertex(0); };
  std::stable_sort(order.begin(), order.end(),
                   [&](Iterator a, Iterator b) { return corner(a) < corner(b); });
  std::vector<Tree::Point_and_primitive_id> starts;
  for (const Iterator triangle : order) {
    if (!starts.empty() && starts.back().first == corner(triangle)) continue;
    starts.emplace_back(corner(triangle), triangle);
  }
  return starts;
}

}  // namespace

Eigen::Vector3d coordinates_in(const Mesh& mesh, int triangle, const Eigen::Vector3d& point) {
  Eigen::Matrix3d spokes;  // from the point to the corners
  for (int k = 0; k < 3; ++k) {
    spokes.col(k) = mesh.positions.row(mesh.triangles(triangle, k)).transpose() - point;
  }
  Eigen::Vector3d areas;
  for (int k = 0; k < 3; ++k)
    areas(k) = spokes.col((k + 1) % 3).cross(spokes.col((k + 2) % 3)).norm();
  // In a triangle without area every corner is as good.
  return areas.sum() > 0 ? Eigen::Vector3d(areas / areas.sum()) : Eigen::Vector3d(1, 0, 0);
}

Eigen::Vector3d position_of(const Mesh& mesh, const SurfacePoint& at) {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();
  for (int k = 0; k < 3; ++k) {
    position += at.barycentric(k) * mesh.positions.row(mesh.triangles(at.triangle, k)).transpose();
  }
  return position;
}

std::vector<SurfacePoint> closest_points(const Mesh& mesh, const Positions& positions,
                                         const Observer& observer) {
  const std::vector<Triangle> triangles = triangles_of(mesh);
  Tree tree(triangles.begin(), triangles.end());
  const auto starts = starts_of(triangles);
  tree.accelerate_distance_queries(starts.begin(), starts.end());
  std::vector<SurfacePoint> points;
  points.reserve(static_cast<std::size_t>(positions.rows()));
  for (Eigen::Index i = 0; i < positions.rows(); ++i) {
    if (i % kStride == 0) stop_if_cancelled(observer);
    const auto [point, found] =
        tree.closest_point_and_primitive(Point(positions(i, 0), positions(i, 1), positions(i, 2)));
    const auto triangle = static_cast<int>(found - triangles.begin());
    points.push_back({triangle, coordinates_in(mesh, triangle, {point.x(), point.y(), point.z()})});
  }
  return points;
}

SurfacePoint closest_point(const Mesh& mesh, const Eigen::Vector3d& position) {
  return closest_points(mesh, position.transpose()).front();
}

}  // namespace morphbake
