#include "morphbake/transition/regions.h"

#include "morphbake/mesh/closest_point.h"
#include "morphbake/mesh/measures.h"
#include "morphbake/transition/surface_distance.h"

namespace morphbake {
namespace {

/// d = (r - inner) / (outer - inner) within [0, 1]; a step at the radius when both are equal.
Eigen::VectorXd soft_step(const Eigen::VectorXd& r, double inner, double outer) {
  if (outer > inner) return ((r.array() - inner) / (outer - inner)).max(0).min(1);
  return (r.array() > inner).cast<double>();
}

Eigen::VectorXd ball_distance(const MorphableMesh& morphable, const BallRegion& ball, Units units) {
  const Mesh mesh{morphable.geometries[static_cast<std::size_t>(ball.source)],
                  morphable.connectivity.triangles};
  const SurfacePoint centre = closest_point(mesh, std::get<Eigen::Vector3d>(ball.centre));
  const Eigen::VectorXd r = ball.distance == DistanceMeasure::Edges
                                ? edge_distances(mesh, centre)
                                : geodesic_distances(mesh, {centre}).front();
  const double unit = units == Units::Scene ? 1 : bounding_diagonal(mesh.positions);
  return soft_step(r, ball.inner * unit, ball.outer * unit);
}

/// Fills regions in the order in which they need one another; a recipe has no cycles.
class RegionTable {
 public:
  RegionTable(const MorphableMesh& mesh, const Recipe& recipe)
      : mesh_(mesh), recipe_(recipe), distances_(recipe.regions.size()) {}

  const Eigen::VectorXd& distance(int region) {
    Eigen::VectorXd& d = distances_[static_cast<std::size_t>(region)];
    if (d.size() > 0) return d;
    const auto& shape = recipe_.regions[static_cast<std::size_t>(region)].shape;
    if (const auto* ball = std::get_if<BallRegion>(&shape)) {
      d = ball_distance(mesh_, *ball, recipe_.units);
    } else {
      Eigen::VectorXd nearest = Eigen::VectorXd::Ones(mesh_.connectivity.vertex_count);
      for (const int other : std::get<RestOfRegion>(shape).regions) {
        nearest = nearest.cwiseMin(distance(other));
      }
      d = 1 - nearest.array();
    }
    return d;
  }

  std::vector<Eigen::VectorXd> all() {
    for (std::size_t region = 0; region < distances_.size(); ++region)
      distance(static_cast<int>(region));
    return std::move(distances_);
  }

 private:
  const MorphableMesh& mesh_;
  const Recipe& recipe_;
  std::vector<Eigen::VectorXd> distances_;  // sized up front: references into it stay valid
};

}  // namespace

std::vector<Eigen::VectorXd> region_distances(const MorphableMesh& mesh, const Recipe& recipe) {
  return RegionTable(mesh, recipe).all();
}

}  // namespace morphbake
