#include <functional>
#include <limits>
#include <queue>
#include <utility>

#include "morphbake/mesh/adjacency.h"
#include "morphbake/mesh/closest_point.h"
#include "morphbake/transition/surface_distance.h"

namespace morphbake {

Eigen::VectorXd edge_distances(const Mesh& mesh, const PointSet& from) {
  const auto vertex_count = static_cast<int>(mesh.positions.rows());
  const OneRings rings = one_rings({vertex_count, mesh.triangles});
  Eigen::VectorXd distance =
      Eigen::VectorXd::Constant(vertex_count, std::numeric_limits<double>::infinity());
  using Entry = std::pair<double, int>;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> front;
  const auto reach = [&](int vertex, double length) {
    if (length >= distance(vertex)) return;
    distance(vertex) = length;
    front.emplace(length, vertex);
  };

  for (const SurfacePoint& at : from) {
    const Eigen::RowVector3d point = position_of(mesh, at).transpose();
    for (int k = 0; k < 3; ++k) {
      const int corner = mesh.triangles(at.triangle, k);
      reach(corner, (mesh.positions.row(corner) - point).norm());
    }
  }
  while (!front.empty()) {
    const auto [length, vertex] = front.top();
    front.pop();
    if (length > distance(vertex)) continue;
    const auto v = static_cast<std::size_t>(vertex);
    for (int n = rings.offsets[v]; n < rings.offsets[v + 1]; ++n) {
      const int neighbour = rings.neighbours[static_cast<std::size_t>(n)];
      reach(neighbour,
            length + (mesh.positions.row(neighbour) - mesh.positions.row(vertex)).norm());
    }
  }
  return distance;
}

Eigen::VectorXd hop_distances(const Mesh& mesh, const std::vector<int>& from) {
  const auto vertex_count = static_cast<int>(mesh.positions.rows());
  const OneRings rings = one_rings({vertex_count, mesh.triangles});
  constexpr double kUnreached = std::numeric_limits<double>::infinity();
  Eigen::VectorXd hops = Eigen::VectorXd::Constant(vertex_count, kUnreached);
  std::vector<int> reached;
  const auto reach = [&](int vertex, double count) {
    if (hops(vertex) != kUnreached) return;
    hops(vertex) = count;
    reached.push_back(vertex);
  };
  for (const int vertex : from) reach(vertex, 0);
  for (std::size_t next = 0; next < reached.size(); ++next) {
    const auto v = static_cast<std::size_t>(reached[next]);
    for (int n = rings.offsets[v]; n < rings.offsets[v + 1]; ++n) {
      reach(rings.neighbours[static_cast<std::size_t>(n)], hops(reached[next]) + 1);
    }
  }
  return hops;
}

}  // namespace morphbake
