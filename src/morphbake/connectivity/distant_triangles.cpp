#include "morphbake/connectivity/distant_triangles.h"

#include <algorithm>
#include <cmath>

#include "morphbake/connectivity/point_distance.h"
#include "morphbake/mesh/closest_point.h"

namespace morphbake {
namespace {

using Eigen::Vector3d;

std::size_t index(int i) { return static_cast<std::size_t>(i); }

/// A point of one surface that may be far from the other, and the triangle to refine if it is.
struct Suspect {
  Vector3d position;
  int triangle = -1;
};

/// Into how many pieces an edge is cut to look at the points between.
int pieces_of(double length, double bound) {
  constexpr double kSpacing = 10;  // bounds
  return std::clamp(static_cast<int>(std::ceil(length / (kSpacing * bound))), 2, 8);
}

Mesh lifted_mesh(const LayeredTriangulation& t, const Layer& layer) {
  Mesh mesh{Positions(t.mesh.vertex_slots(), 3), {}};
  for (int v = 0; v < t.mesh.vertex_slots(); ++v) mesh.positions.row(v) = layer.lifted[index(v)];
  std::vector<int> corners;
  for (int f = 0; f < t.mesh.triangle_slots(); ++f) {
    if (!t.mesh.has_triangle(f) || t.is_cap(f)) continue;
    for (int h = 3 * f; h < 3 * f + 3; ++h) corners.push_back(t.mesh.from(h));
  }
  mesh.triangles =
      Eigen::Map<const Triangles>(corners.data(), static_cast<Eigen::Index>(corners.size() / 3), 3);
  return mesh;
}

Mesh source_mesh(const SphereAtlas& atlas) {
  Mesh mesh{Positions(static_cast<Eigen::Index>(atlas.positions.size()), 3),
            atlas.map->surface.triangles};
  for (std::size_t v = 0; v < atlas.positions.size(); ++v) {
    mesh.positions.row(static_cast<Eigen::Index>(v)) = atlas.positions[v];
  }
  return mesh;
}

/// Points of the triangulation that the sphere puts further than `bound` from the source.
std::vector<Suspect> suspects_of_triangulation(const LayeredTriangulation& t, const Layer& layer,
                                               double bound) {
  std::vector<Suspect> suspects;
  const auto look = [&](const Vector3d& place, const Vector3d& chord, int near_vertex, int f) {
    const Vector3d x = place.normalized();
    const int below = layer.atlas.locate(x, layer.triangle[index(near_vertex)]);
    const Vector3d there = layer.atlas.position(below, layer.atlas.weights_at(x, below));
    if ((chord - there).norm() > bound) suspects.push_back({chord, f});
  };
  for (int f = 0; f < t.mesh.triangle_slots(); ++f) {
    if (!t.mesh.has_triangle(f) || t.is_cap(f)) continue;
    Vector3d place = Vector3d::Zero(), chord = Vector3d::Zero();
    for (int h = 3 * f; h < 3 * f + 3; ++h) {
      const int a = t.mesh.from(h), b = t.mesh.to(h);
      const Vector3d &sa = layer.sphere[index(a)], &sb = layer.sphere[index(b)];
      const Vector3d &pa = layer.lifted[index(a)], &pb = layer.lifted[index(b)];
      place += sa;
      chord += pa / 3;
      if (a > b && !t.is_boundary_edge(h)) continue;  // seen from the other side
      const int pieces = pieces_of((pa - pb).norm(), bound);
      for (int i = 1; i < pieces; ++i) {
        const double share = static_cast<double>(i) / pieces;
        look((1 - share) * sa + share * sb, (1 - share) * pa + share * pb, a, f);
      }
    }
    look(place, chord, t.mesh.from(3 * f), f);
  }
  return suspects;
}

/// Points of the source that the sphere puts further than `bound` from the triangulation.
std::vector<Suspect> suspects_of_source(const LayeredTriangulation& t, const Layer& layer,
                                        std::vector<int>& triangle_of_vertex, double bound) {
  std::vector<Suspect> suspects;
  const SphereAtlas& atlas = layer.atlas;
  const auto look = [&](const Vector3d& place, const Vector3d& position, int start) {
    const int f = triangle_over(t, layer, place.normalized(), start);
    if (t.is_cap(f)) return f;
    const auto corner = [&](int k) { return layer.lifted[index(t.mesh.from(3 * f + k))]; };
    if (point_triangle_distance(position, corner(0), corner(1), corner(2)) > bound) {
      suspects.push_back({position, f});
    }
    return f;
  };
  for (int h = 0; h < static_cast<int>(atlas.opposite.size()); ++h) {
    const int a = atlas.from(h), b = atlas.from(ClosedMesh::next(h));
    if (atlas.opposite[index(h)] >= 0 && a > b) continue;
    const Vector3d &pa = atlas.positions[index(a)], &pb = atlas.positions[index(b)];
    int& last = triangle_of_vertex[index(a)];
    const int pieces = pieces_of((pa - pb).norm(), bound);
    for (int i = 0; i < pieces; ++i) {
      const double share = static_cast<double>(i) / pieces;
      const int f = look((1 - share) * atlas.sphere[index(a)] + share * atlas.sphere[index(b)],
                         (1 - share) * pa + share * pb, last);
      if (i == 0) last = f;
    }
  }
  return suspects;
}

/// The triangles of suspects that are indeed further than `bound` from a mesh.
void append_guilty(const std::vector<Suspect>& suspects, const Mesh& mesh, double bound,
                   std::vector<int>& triangles) {
  if (suspects.empty()) return;
  Positions positions(static_cast<Eigen::Index>(suspects.size()), 3);
  for (std::size_t i = 0; i < suspects.size(); ++i) {
    positions.row(static_cast<Eigen::Index>(i)) = suspects[i].position;
  }
  const std::vector<SurfacePoint> nearest = closest_points(mesh, positions);
  for (std::size_t i = 0; i < suspects.size(); ++i) {
    const double distance = (position_of(mesh, nearest[i]) - suspects[i].position).norm();
    if (distance > bound) triangles.push_back(suspects[i].triangle);
  }
}

}  // namespace

std::vector<int> distant_triangles(const LayeredTriangulation& t, std::size_t layer,
                                   SourcePoints& points, double bound) {
  const Layer& on = t.layers[layer];
  const double length = bound * on.atlas.diagonal;
  std::vector<int> triangles;
  append_guilty(suspects_of_triangulation(t, on, length), source_mesh(on.atlas), length, triangles);
  append_guilty(suspects_of_source(t, on, points.triangle[layer], length), lifted_mesh(t, on),
                length, triangles);
  std::sort(triangles.begin(), triangles.end());
  triangles.erase(std::unique(triangles.begin(), triangles.end()), triangles.end());
  return triangles;
}

}  // namespace morphbake
