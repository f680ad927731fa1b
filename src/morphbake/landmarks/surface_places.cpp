#include "morphbake/landmarks/surface_places.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "morphbake/mesh/adjacency.h"
#include "morphbake/mesh/boundary.h"
#include "morphbake/mesh/closest_point.h"
#include "morphbake/mesh/measures.h"
#include "morphbake/mesh/surface_point.h"

namespace morphbake {
namespace {

constexpr double kAround = 0.02;   // of the diagonal: how far a tip may have moved in the sketch
constexpr double kTipSize = 0.12;  // in `reach`: what belongs to a tip

/// The direction in which a tip points: from the middle of what is around it.
Eigen::RowVector3d pointing(const Side& side, const Eigen::VectorXd& distance, int vertex) {
  Eigen::RowVector3d sum = Eigen::RowVector3d::Zero();
  int count = 0;
  for (Eigen::Index v = 0; v < distance.size(); ++v) {
    if (distance(v) > kTipSize) continue;
    sum += side.sketch.mesh.positions.row(v);
    ++count;
  }
  return side.sketch.mesh.positions.row(vertex) - sum / std::max(count, 1);
}

/// What of a surface is near to a place and joined to a vertex there.
struct Neighbourhood {
  int first = 0;  ///< vertex
  Eigen::RowVector3d start;
  double around = 0;
};

/// The vertex of a neighbourhood that lies furthest in `direction`: only what is joined to its
/// first counts, so that a finger does not give its tip to the next.
Eigen::RowVector3d outermost(const Mesh& surface, const OneRings& rings, const Neighbourhood& near,
                             const Eigen::RowVector3d& direction) {
  const auto& [first, start, around] = near;
  std::vector<int> reached = {first};
  std::vector<char> is_reached(static_cast<std::size_t>(surface.positions.rows()), 0);
  is_reached[static_cast<std::size_t>(first)] = 1;
  Eigen::RowVector3d best = start;
  double furthest = -std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < reached.size(); ++i) {
    const auto v = static_cast<std::size_t>(reached[i]);
    const Eigen::RowVector3d position = surface.positions.row(reached[i]);
    if ((position - start).squaredNorm() > around * around) continue;
    if (position.dot(direction) > furthest) {
      furthest = position.dot(direction);
      best = position;
    }
    for (int n = rings.offsets[v]; n < rings.offsets[v + 1]; ++n) {
      const int neighbour = rings.neighbours[static_cast<std::size_t>(n)];
      if (std::exchange(is_reached[static_cast<std::size_t>(neighbour)], 1) == 0) {
        reached.push_back(neighbour);
      }
    }
  }
  return best;
}

Eigen::RowVector3d closest_on_rim(const Mesh& surface, const std::vector<int>& rim,
                                  const Eigen::RowVector3d& position) {
  Eigen::Index closest = 0;
  const Positions loop = surface.positions(rim, Eigen::all);
  (loop.rowwise() - position).rowwise().squaredNorm().minCoeff(&closest);
  return loop.row(closest);
}

}  // namespace

Positions places_on_surface(const Mesh& surface, const Side& side, const std::vector<int>& vertices,
                            const std::vector<PairKind>& kinds) {
  Positions places = side.sketch.mesh.positions(vertices, Eigen::all);
  const bool is_coarser = side.sketch.mesh.positions.rows() < surface.positions.rows();
  if (!is_coarser) return places;
  const double around = kAround * bounding_diagonal(surface.positions);
  const std::vector<int> rim = longest_boundary(surface);
  const OneRings rings = one_rings({static_cast<int>(surface.positions.rows()), surface.triangles});
  const std::vector<SurfacePoint> closest = closest_points(surface, places);
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    auto place = places.row(static_cast<Eigen::Index>(i));
    const Eigen::RowVector3d start = place;
    if (kinds[i] == PairKind::Tip) {
      place = outermost(surface, rings, {nearest_corner(surface, closest[i]), start, around},
                        pointing(side, side.from_landmark[i], vertices[i]));
    } else if (kinds[i] == PairKind::Rim && !rim.empty()) {
      place = closest_on_rim(surface, rim, start);
    } else {
      place = position_of(surface, closest[i]).transpose();
    }
  }
  return places;
}

}  // namespace morphbake
