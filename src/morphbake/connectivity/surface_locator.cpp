#include "morphbake/connectivity/surface_locator.h"

#include <CGAL/AABB_traits.h>
#include <CGAL/AABB_tree.h>
#include <CGAL/AABB_triangle_primitive.h>
#include <CGAL/Simple_cartesian.h>

#include <Eigen/Geometry>
#include <cmath>
#include <vector>

namespace morphbake {
namespace {

using Kernel = CGAL::Simple_cartesian<double>;
using Point = Kernel::Point_3;
using Corners = std::vector<Kernel::Triangle_3>;
using Primitive = CGAL::AABB_triangle_primitive<Kernel, Corners::const_iterator>;

constexpr double kOnEdge = 1e-12;  // barycentric coordinates below are rounding errors

Point to_cgal(const Eigen::Vector3d& position) {
  return {position.x(), position.y(), position.z()};
}

/// Barycentric coordinates of a point in the plane of a triangle, clamped into it.
Eigen::Vector3d barycentric(const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                            const Eigen::Vector3d& c, const Eigen::Vector3d& point) {
  const Eigen::Vector3d normal = (b - a).cross(c - a);
  Eigen::Vector3d weights(normal.dot((c - b).cross(point - b)),
                          normal.dot((a - c).cross(point - c)),
                          normal.dot((b - a).cross(point - a)));
  weights /= normal.squaredNorm();
  weights = (weights.array() < kOnEdge).select(0, weights);
  return weights / weights.sum();
}

}  // namespace

struct SurfaceLocator::Tree {
  Corners corners;
  std::vector<int> triangles;  ///< index in the mesh of each entry of `corners`
  CGAL::AABB_tree<CGAL::AABB_traits<Kernel, Primitive>> search;
};

SurfaceLocator::SurfaceLocator(const Mesh& mesh) : mesh_(mesh), tree_(std::make_unique<Tree>()) {
  for (int f = 0; f < mesh.triangles.rows(); ++f) {
    const Eigen::Vector3d a = mesh.positions.row(mesh.triangles(f, 0));
    const Eigen::Vector3d b = mesh.positions.row(mesh.triangles(f, 1));
    const Eigen::Vector3d c = mesh.positions.row(mesh.triangles(f, 2));
    if (!((b - a).cross(c - a).squaredNorm() > 0)) continue;
    tree_->corners.emplace_back(to_cgal(a), to_cgal(b), to_cgal(c));
    tree_->triangles.push_back(f);
  }
  tree_->search.rebuild(tree_->corners.cbegin(), tree_->corners.cend());
  tree_->search.accelerate_distance_queries();
}

SurfaceLocator::~SurfaceLocator() = default;

SurfacePoint SurfaceLocator::closest(const Eigen::Vector3d& position) const {
  const auto [point, at] = tree_->search.closest_point_and_primitive(to_cgal(position));
  const int f = tree_->triangles[static_cast<std::size_t>(at - tree_->corners.cbegin())];
  return {f, barycentric(mesh_.positions.row(mesh_.triangles(f, 0)),
                         mesh_.positions.row(mesh_.triangles(f, 1)),
                         mesh_.positions.row(mesh_.triangles(f, 2)),
                         Eigen::Vector3d(point.x(), point.y(), point.z()))};
}

double SurfaceLocator::distance(const Eigen::Vector3d& position) const {
  return std::sqrt(CGAL::to_double(tree_->search.squared_distance(to_cgal(position))));
}

}  // namespace morphbake
