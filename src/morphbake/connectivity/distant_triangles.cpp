#include "morphbake/connectivity/distant_triangles.h"

#include <algorithm>
#include <cmath>

#include "morphbake/connectivity/point_distance.h"
#include "morphbake/mesh/closest_point.h"

namespace morphbake {
namespace {

using Eigen::Vector3d;

std::size_t index(int i) { return static_cast<std::size_t>(i); }

/// Tangled surfaces are suspect nearly everywhere; beyond so many, few points a triangle must do.
constexpr std::size_t kManySuspects = 200000;

/// A point of one surface that may be far from the other, and the triangle to refine if it is.
struct Suspect {
  Vector3d position;
  int triangle = -1;
};

/// Looks at points spread over a triangle, its corners and edges included: at few, and where one of
/// them is not clearly near, at many. `distance(weights)` is that of a point from the other
/// surface; `far(weights)` is called where it is above `bound`.
template <typename Distance, typename Far>
void spread(const Eigen::Matrix3d& corners, double bound, bool is_thorough,
            const Distance& distance, const Far& far) {
  constexpr double kFew = 2, kMany = 0.5;  // bounds between points
  constexpr double kClearlyNear = 0.6;     // bounds
  const double longest =
      std::max({(corners.col(0) - corners.col(1)).norm(), (corners.col(1) - corners.col(2)).norm(),
                (corners.col(2) - corners.col(0)).norm()});
  const auto each = [&](double spacing, const auto& look) {
    const int pieces = std::clamp(static_cast<int>(std::ceil(longest / (spacing * bound))), 2, 64);
    for (int i = 0; i <= pieces; ++i) {
      for (int k = 0; i + k <= pieces; ++k) look(Vector3d(i, k, pieces - i - k) / pieces);
    }
  };
  double largest = 0;
  each(kFew, [&](const Vector3d& weights) { largest = std::max(largest, distance(weights)); });
  if (largest < kClearlyNear * bound) return;
  each(is_thorough ? kMany : kFew, [&](const Vector3d& weights) {
    if (distance(weights) > bound) far(weights);
  });
}

/// Points of the triangulation that the sphere puts further than `bound` from the source.
std::vector<Suspect> suspects_of_triangulation(const LayeredTriangulation& t, const Layer& layer,
                                               double bound) {
  std::vector<Suspect> suspects;
  for (const int f : surface_triangles(t)) {
    stop_if_cancelled(t.observer);
    Eigen::Matrix3d place, chord;  // columns are corners
    for (int k = 0; k < 3; ++k) {
      place.col(k) = layer.sphere[index(t.mesh.from(3 * f + k))];
      chord.col(k) = layer.lifted[index(t.mesh.from(3 * f + k))];
    }
    int below = layer.triangle[index(t.mesh.from(3 * f))];
    const auto distance = [&](const Vector3d& weights) {
      const Vector3d x = (place * weights).normalized();
      below = layer.atlas.locate(x, below);
      const Vector3d there = layer.atlas.position(below, layer.atlas.weights_at(x, below));
      return (chord * weights - there).norm();
    };
    spread(chord, bound, suspects.size() < kManySuspects, distance, [&](const Vector3d& weights) {
      suspects.push_back({chord * weights, f});
    });
  }
  return suspects;
}

/// Points of the source that the sphere puts further than `bound` from the triangulation.
std::vector<Suspect> suspects_of_source(const LayeredTriangulation& t, const Layer& layer,
                                        const std::vector<int>& triangle_of_vertex, double bound) {
  std::vector<Suspect> suspects;
  const SphereAtlas& atlas = layer.atlas;
  for (int f = 0; f < static_cast<int>(atlas.normals.size()); ++f) {
    stop_if_cancelled(t.observer);
    Eigen::Matrix3d place, position;  // columns are corners
    for (int k = 0; k < 3; ++k) {
      place.col(k) = atlas.sphere[index(atlas.from(3 * f + k))];
      position.col(k) = atlas.positions[index(atlas.from(3 * f + k))];
    }
    int above = triangle_of_vertex[index(atlas.from(3 * f))];
    const auto distance = [&](const Vector3d& weights) {
      above = triangle_over(t, layer, (place * weights).normalized(), above);
      if (t.is_cap(above)) return 0.0;
      const auto corner = [&](int k) { return layer.lifted[index(t.mesh.from(3 * above + k))]; };
      return point_triangle_distance(position * weights, corner(0), corner(1), corner(2));
    };
    spread(position, bound, suspects.size() < kManySuspects, distance,
           [&](const Vector3d& weights) {
             suspects.push_back({position * weights, above});
           });
  }
  return suspects;
}

/// The triangles of suspects that are indeed further than `bound` from the other surface.
///
/// @param surface  surface(): that one; asked only where it is needed
template <typename Surface>
void append_guilty(const std::vector<Suspect>& suspects, const Surface& surface, double bound,
                   const Observer& observer, std::vector<int>& triangles) {
  if (suspects.empty()) return;
  const Mesh mesh = surface();
  Positions positions(static_cast<Eigen::Index>(suspects.size()), 3);
  for (std::size_t i = 0; i < suspects.size(); ++i) {
    positions.row(static_cast<Eigen::Index>(i)) = suspects[i].position;
  }
  const std::vector<SurfacePoint> nearest = closest_points(mesh, positions, observer);
  for (std::size_t i = 0; i < suspects.size(); ++i) {
    const double distance = (position_of(mesh, nearest[i]) - suspects[i].position).norm();
    if (distance > bound) triangles.push_back(suspects[i].triangle);
  }
}

}  // namespace

std::vector<int> distant_triangles(const LayeredTriangulation& t, std::size_t layer,
                                   const SourcePoints& points, double bound) {
  const Layer& on = t.layers[layer];
  const double length = bound * on.atlas.diagonal;
  std::vector<int> triangles;
  append_guilty(
      suspects_of_triangulation(t, on, length), [&] { return on.atlas.mesh(); }, length, t.observer,
      triangles);
  append_guilty(
      suspects_of_source(t, on, points.triangle[layer], length),
      [&] { return lifted_mesh(t, on, surface_triangles(t)); }, length, t.observer, triangles);
  std::sort(triangles.begin(), triangles.end());
  triangles.erase(std::unique(triangles.begin(), triangles.end()), triangles.end());
  return triangles;
}

}  // namespace morphbake
