#include "morphbake/mesh/surface_edges.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "morphbake/mesh/sides.h"

namespace morphbake {
namespace {

int apex_of(const Triangles& triangles, const TriangleSide& side) {
  return triangles(side.triangle, (side.corner + 2) % 3);
}

double bend_angle(const Positions& positions, const std::array<int, 2>& ends,
                  const std::array<int, 2>& apexes) {
  const auto from_low = [&](int vertex) -> Eigen::Vector3d {
    return positions.row(vertex) - positions.row(ends[0]);
  };
  const Eigen::Vector3d edge = from_low(ends[1]);
  const Eigen::Vector3d left = edge.cross(from_low(apexes[0]));
  const Eigen::Vector3d right = from_low(apexes[1]).cross(edge);
  // False for NaN too. Squares of areas would vanish for tiny meshes, so lengths are compared.
  if (!(left.stableNorm() > 0 && right.stableNorm() > 0)) {
    return std::numeric_limits<double>::quiet_NaN();
  }
  const Eigen::Vector3d n = left.stableNormalized(), m = right.stableNormalized();
  const double angle = std::atan2(n.cross(m).dot(edge.stableNormalized()), n.dot(m));
  return angle * 180 / std::numbers::pi;
}

}  // namespace

SurfaceEdges surface_edges(const Triangles& triangles) {
  SurfaceEdges edges;
  edges.is_closed = triangles.rows() > 0;
  const std::vector<TriangleSide> sides = sorted_sides(triangles);
  for_each_edge(sides, [&](auto first, auto last) {
    const auto forward =
        std::count_if(first, last, [](const TriangleSide& side) { return side.forward; });
    if (2 * forward != last - first) edges.is_closed = false;
    edges.ends.push_back({first->low, first->high});
    std::array<int, 2> apexes{-1, -1};
    if (last - first == 2 && forward == 1) {
      const auto [left, right] =
          first->forward ? std::pair(first, first + 1) : std::pair(first + 1, first);
      apexes = {apex_of(triangles, *left), apex_of(triangles, *right)};
    }
    edges.apexes.push_back(apexes);
  });
  return edges;
}

Eigen::VectorXd edge_lengths(const Positions& positions, const SurfaceEdges& edges) {
  Eigen::VectorXd lengths(static_cast<Eigen::Index>(edges.ends.size()));
  for (Eigen::Index e = 0; e < lengths.size(); ++e) {
    const auto [low, high] = edges.ends[static_cast<std::size_t>(e)];
    lengths(e) = (positions.row(high) - positions.row(low)).norm();
  }
  return lengths;
}

Eigen::VectorXd bend_angles(const Positions& positions, const SurfaceEdges& edges) {
  Eigen::VectorXd angles(static_cast<Eigen::Index>(edges.ends.size()));
  for (Eigen::Index e = 0; e < angles.size(); ++e) {
    const auto i = static_cast<std::size_t>(e);
    angles(e) = edges.apexes[i][0] < 0 ? std::numeric_limits<double>::quiet_NaN()
                                       : bend_angle(positions, edges.ends[i], edges.apexes[i]);
  }
  return angles;
}

}  // namespace morphbake
