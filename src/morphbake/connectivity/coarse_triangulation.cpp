#include <algorithm>

#include "morphbake/connectivity/layered_triangulation.h"
#include "morphbake/correspondence/sphere_layout.h"

namespace morphbake {
namespace {

using Eigen::Vector3d;

std::size_t index(int i) { return static_cast<std::size_t>(i); }

/// The first source's surface, closed again by an apex if it is a disk.
CappedSurface capped_again(const SphereAtlas& atlas) {
  const SphericalMap& map = *atlas.map;
  CappedSurface capped;
  capped.on_boundary = map.on_boundary;
  capped.landmarks = map.landmarks;
  std::vector<int> border;  // half-edges
  for (int h = 0; h < static_cast<int>(atlas.opposite.size()); ++h) {
    if (atlas.opposite[index(h)] < 0) border.push_back(h);
  }
  if (border.empty()) {
    capped.positions = map.surface.positions;
    capped.triangles = map.surface.triangles;
    return capped;
  }
  const Eigen::Index vertices = map.surface.positions.rows();
  const Eigen::Index triangles = map.surface.triangles.rows();
  capped.apex = static_cast<int>(vertices);
  capped.on_boundary.push_back(0);
  capped.positions.resize(vertices + 1, 3);
  capped.positions.topRows(vertices) = map.surface.positions;
  capped.positions.row(vertices) = map.surface.positions.colwise().mean();
  capped.triangles.resize(triangles + static_cast<Eigen::Index>(border.size()), 3);
  capped.triangles.topRows(triangles) = map.surface.triangles;
  Eigen::Index row = triangles;
  for (const int h : border) {
    capped.triangles.row(row++) << atlas.from(ClosedMesh::next(h)), atlas.from(h), capped.apex;
  }
  return capped;
}

/// Allows collapses that turn no triangle on the sphere and none by much in space.
bool keeps_shape(const SphereLayout& layout, const ClosedMesh& mesh, int h) {
  constexpr double kLeastCosine = 0.2;
  const int u = mesh.from(h), v = mesh.to(h);
  if (std::find(layout.surface->landmarks.begin(), layout.surface->landmarks.end(), u) !=
      layout.surface->landmarks.end()) {
    return false;
  }
  bool keeps = true;
  mesh.around(u, [&](int g) {
    const int a = mesh.to(g), b = mesh.apex(g);
    if (!keeps || a == v || b == v) return;
    keeps = is_positive(layout.sphere[index(v)], layout.sphere[index(a)], layout.sphere[index(b)]);
    if (a == layout.surface->apex || b == layout.surface->apex) return;
    const auto normal = [&](int w) -> Vector3d {
      return (layout.positions[index(a)] - layout.positions[index(w)])
          .cross(layout.positions[index(b)] - layout.positions[index(w)]);
    };
    const Vector3d before = normal(u), after = normal(v);
    keeps = keeps && before.dot(after) >= kLeastCosine * before.norm() * after.norm();
  });
  return keeps;
}

/// Renumbers the living vertices; -1 of dead ones.
std::vector<int> living_numbers(const ClosedMesh& mesh) {
  std::vector<int> number(index(mesh.vertex_slots()), -1);
  int count = 0;
  for (int v = 0; v < mesh.vertex_slots(); ++v) {
    if (mesh.has_vertex(v)) number[index(v)] = count++;
  }
  return number;
}

}  // namespace

LayeredTriangulation coarse_triangulation(const std::vector<SphericalMap>& maps, int count,
                                          const Observer& observer) {
  std::vector<Layer> layers;
  for (const SphericalMap& map : maps) {
    stop_if_cancelled(observer);
    layers.push_back({SphereAtlas(map), {}, {}, {}});
  }
  const CappedSurface capped = capped_again(layers[0].atlas);
  SphereLayout layout = make_layout(capped);
  for (Eigen::Index v = 0; v < maps[0].sphere.rows(); ++v) {
    layout.sphere[static_cast<std::size_t>(v)] = maps[0].sphere.row(v);
  }
  if (capped.apex >= 0) layout.sphere[index(capped.apex)] = -Vector3d::UnitZ();
  const auto allowed = [&](const ClosedMesh& mesh, int h) { return keeps_shape(layout, mesh, h); };
  coarsen(layout, count + (capped.apex >= 0), allowed, observer);

  const std::vector<int> number = living_numbers(layout.mesh);
  Triangles triangles = layout.mesh.triangles();
  for (Eigen::Index c = 0; c < triangles.size(); ++c) {
    triangles.data()[c] = number[index(triangles.data()[c])];
  }
  const int living = layout.mesh.vertex_count();
  LayeredTriangulation t{ClosedMesh(triangles, living),
                         std::move(layers),
                         std::vector<char>(index(living), 0),
                         std::vector<char>(index(living), 0),
                         capped.apex < 0 ? -1 : number[index(capped.apex)],
                         {},
                         {},
                         observer};
  for (int v = 0; v < layout.mesh.vertex_slots(); ++v) {
    if (number[index(v)] < 0) continue;
    const auto n = index(number[index(v)]);
    t.on_boundary[n] = capped.on_boundary[index(v)];
    for (std::size_t s = 0; s < t.layers.size(); ++s) {
      Layer& layer = t.layers[s];
      layer.sphere.push_back(layout.sphere[index(v)]);
      layer.lifted.emplace_back(Vector3d::Zero());
      layer.triangle.push_back(0);
      if (v == capped.apex) continue;
      const int near = s == 0 ? layer.atlas.triangle_of_vertex[index(v)] : 0;
      lift(layer, static_cast<int>(n), layout.sphere[index(v)], near);
    }
  }
  if (t.apex >= 0) t.is_fixed[index(t.apex)] = 1;
  for (std::size_t l = 0; l < capped.landmarks.size(); ++l) {
    const auto n = index(number[index(capped.landmarks[l])]);
    t.is_fixed[n] = 1;
    t.landmarks.push_back(static_cast<int>(n));
    for (Layer& layer : t.layers) {
      lift_onto(layer, static_cast<int>(n), layer.atlas.map->landmarks[l]);
    }
  }
  return t;
}

}  // namespace morphbake
