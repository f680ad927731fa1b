#include <functional>
#include <limits>
#include <queue>
#include <utility>

#include "morphbake/mesh/adjacency.h"
#include "morphbake/transition/surface_distance.h"

namespace morphbake {

Eigen::VectorXd edge_distances(const Mesh& mesh, const SurfacePoint& centre) {
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

  Eigen::RowVector3d point = Eigen::RowVector3d::Zero();
  for (int k = 0; k < 3; ++k) {
    point += centre.barycentric(k) * mesh.positions.row(mesh.triangles(centre.triangle, k));
  }
  for (int k = 0; k < 3; ++k) {
    const int corner = mesh.triangles(centre.triangle, k);
    reach(corner, (mesh.positions.row(corner) - point).norm());
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

}  // namespace morphbake
