#include "morphbake/mesh/facing_point.h"

#include <CGAL/AABB_traits.h>
#include <CGAL/AABB_tree.h>
#include <CGAL/AABB_triangle_primitive.h>
#include <CGAL/Simple_cartesian.h>

#include <Eigen/Geometry>
#include <vector>

#include "morphbake/mesh/closest_point.h"
#include "morphbake/mesh/surface_point.h"

namespace morphbake {
namespace {

using Kernel = CGAL::Simple_cartesian<double>;
using Triangle = Kernel::Triangle_3;
using Iterator = std::vector<Triangle>::const_iterator;
using Traits = CGAL::AABB_traits<Kernel, CGAL::AABB_triangle_primitive<Kernel, Iterator>>;

Kernel::Point_3 point_of(const Eigen::Vector3d& position) {
  return {position.x(), position.y(), position.z()};
}

/// CGAL's search for the closest point, which passes over triangles that face away.
class FacingTraversal {
 public:
  using Node = CGAL::AABB_node<Traits>;

  FacingTraversal(const Traits& traits, const Kernel::Vector_3& normal,
                  const Kernel::Point_3& start)
      : traits_(traits), normal_(normal), closest_(start) {}

  bool go_further() const { return true; }

  void intersection(const Kernel::Point_3& query, const Traits::Primitive& primitive) {
    const Triangle& triangle = *primitive.id();
    const Kernel::Vector_3 own =
        CGAL::cross_product(triangle[1] - triangle[0], triangle[2] - triangle[0]);
    if (!(own * normal_ > 0)) return;
    const Kernel::Point_3 closer = traits_.closest_point_object()(query, primitive, closest_);
    if (closer == closest_) return;
    closest_ = closer;
    found_ = primitive.id();
    is_found_ = true;
  }

  bool do_intersect(const Kernel::Point_3& query, const Node& node) const {
    return traits_.compare_distance_object()(query, node.bbox(), closest_) == CGAL::SMALLER;
  }

  bool is_found() const { return is_found_; }

  Iterator triangle() const { return found_; }

  const Kernel::Point_3& closest() const { return closest_; }

 private:
  const Traits& traits_;
  Kernel::Vector_3 normal_;
  Kernel::Point_3 closest_;
  Iterator found_;
  bool is_found_ = false;
};

}  // namespace

struct FacingPoints::Tree {
  const Mesh& mesh;
  std::vector<Triangle> triangles;
  CGAL::AABB_tree<Traits> search;
};

FacingPoints::FacingPoints(const Mesh& mesh) : tree_(new Tree{mesh, {}, {}}) {
  tree_->triangles.reserve(static_cast<std::size_t>(mesh.triangles.rows()));
  for (Eigen::Index f = 0; f < mesh.triangles.rows(); ++f) {
    const auto corner = [&](int k) {
      return point_of(mesh.positions.row(mesh.triangles(f, k)).transpose());
    };
    tree_->triangles.emplace_back(corner(0), corner(1), corner(2));
  }
  tree_->search.insert(tree_->triangles.cbegin(), tree_->triangles.cend());
  tree_->search.build();  // now: later it would be on several threads
}

FacingPoints::~FacingPoints() = default;

SurfacePoint FacingPoints::find(const Eigen::Vector3d& position, const Eigen::Vector3d& normal,
                                const SurfacePoint& near) const {
  FacingTraversal traversal(tree_->search.traits(), {normal.x(), normal.y(), normal.z()},
                            point_of(position_of(tree_->mesh, near)));
  tree_->search.traversal(point_of(position), traversal);
  if (!traversal.is_found()) return near;
  const auto triangle = static_cast<int>(traversal.triangle() - tree_->triangles.cbegin());
  const Kernel::Point_3& at = traversal.closest();
  return {triangle, coordinates_in(tree_->mesh, triangle, {at.x(), at.y(), at.z()})};
}

}  // namespace morphbake
