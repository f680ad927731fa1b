#include <algorithm>
#include <utility>
#include <vector>

#include "morphbake/connectivity/layered_triangulation.h"
#include "morphbake/connectivity/shared_triangulation.h"

namespace morphbake {
namespace {

std::size_t index(int i) { return static_cast<std::size_t>(i); }

}  // namespace

SharedTriangulation shared_triangulation(const LayeredTriangulation& t) {
  SharedTriangulation shared;
  std::vector<int> number(index(t.mesh.vertex_slots()), -1);
  std::vector<int> living;
  for (int v = 0; v < t.mesh.vertex_slots(); ++v) {
    if (!t.mesh.has_vertex(v) || v == t.apex) continue;
    number[index(v)] = static_cast<int>(living.size());
    living.push_back(v);
    shared.on_boundary.push_back(t.on_boundary[index(v)]);
  }
  for (const int v : t.landmarks) shared.landmarks.push_back(number[index(v)]);
  for (const std::uint64_t key : t.hard_edges) {
    const int a = number[key >> 32], b = number[key & 0xffffffff];
    shared.hard_edges.emplace_back(std::min(a, b), std::max(a, b));
  }
  std::sort(shared.hard_edges.begin(), shared.hard_edges.end(), [](const auto& x, const auto& y) {
    return std::pair(x(0), x(1)) < std::pair(y(0), y(1));
  });
  std::vector<int> corners;
  for (int f = 0; f < t.mesh.triangle_slots(); ++f) {
    if (!t.mesh.has_triangle(f) || t.is_cap(f)) continue;
    for (int k = 0; k < 3; ++k) corners.push_back(number[index(t.mesh.from(3 * f + k))]);
  }
  shared.connectivity = {static_cast<int>(living.size()),
                         Eigen::Map<const Triangles>(
                             corners.data(), static_cast<Eigen::Index>(corners.size() / 3), 3)};
  for (const Layer& layer : t.layers) {
    Positions& geometry = shared.geometries.emplace_back(shared.connectivity.vertex_count, 3);
    Positions& sphere = shared.sphere.emplace_back(shared.connectivity.vertex_count, 3);
    std::vector<SurfacePoint>& on_source = shared.on_source.emplace_back();
    for (int i = 0; i < shared.connectivity.vertex_count; ++i) {
      const auto v = index(living[index(i)]);
      const int f = layer.triangle[v];
      const Eigen::Vector3d weights = layer.atlas.weights_at(layer.sphere[v], f);
      on_source.push_back(point_on_source(*layer.atlas.map, f, weights));
      sphere.row(i) = layer.sphere[v];
      geometry.row(i).setZero();
      for (int k = 0; k < 3; ++k) {
        geometry.row(i) +=
            weights(k) * layer.atlas.map->surface.positions.row(layer.atlas.from(3 * f + k));
      }
    }
  }
  return shared;
}

}  // namespace morphbake
