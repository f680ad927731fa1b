#include "morphbake/connectivity/source_guard.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "morphbake/connectivity/point_distance.h"

namespace morphbake {
namespace {

using Eigen::Vector3d;

std::size_t index(int i) { return static_cast<std::size_t>(i); }

double longitude(const Vector3d& x) { return std::atan2(x.y(), x.x()); }

/// The border vertices of a source by their longitude.
std::vector<std::pair<double, int>> border_points(const SphereAtlas& atlas) {
  std::vector<std::pair<double, int>> border;
  for (int v = 0; v < static_cast<int>(atlas.sphere.size()); ++v) {
    if (atlas.map->on_boundary[index(v)]) border.emplace_back(longitude(atlas.sphere[index(v)]), v);
  }
  std::sort(border.begin(), border.end());
  return border;
}

}  // namespace

SourceGuard::SourceGuard(const LayeredTriangulation& t, SourcePoints& points, double tolerance)
    : t_(t), points_(points), tolerance_(tolerance), below_(t.layers.size()) {
  for (std::size_t s = 0; s < t.layers.size(); ++s) {
    borders_.push_back(border_points(t.layers[s].atlas));
    below_[s].resize(index(t.mesh.triangle_slots()));
    for (const int v : points.order[s]) {
      if (t.layers[s].atlas.map->on_boundary[index(v)]) continue;
      below_[s][index(points.triangle[s][index(v)])].push_back(v);
    }
  }
}

std::vector<Eigen::Vector3d> SourceGuard::samples(
    std::size_t s, const std::vector<int>& triangles,
    const std::vector<std::array<int, 2>>& edges) const {
  const Layer& layer = t_.layers[s];
  std::vector<Vector3d> found;
  for (const int f : triangles) {
    for (const int v : below_[s][index(f)]) found.push_back(layer.atlas.positions[index(v)]);
  }
  for (const auto& [a, b] : edges) {
    const Vector3d place = (layer.sphere[index(a)] + layer.sphere[index(b)]).normalized();
    const int f = layer.atlas.locate(place, layer.triangle[index(a)]);
    found.push_back(layer.atlas.position(f, layer.atlas.weights_at(place, f)));
  }
  return found;
}

double SourceGuard::largest_distance(std::size_t s, const std::vector<Vector3d>& from,
                                     const std::vector<Corners>& triangles) const {
  const Layer& layer = t_.layers[s];
  double largest = 0;
  for (const Vector3d& p : from) {
    double nearest = std::numeric_limits<double>::infinity();
    for (const auto& [a, b, c] : triangles) {
      nearest = std::min(nearest,
                         point_triangle_distance(p, layer.lifted[index(a)], layer.lifted[index(b)],
                                                 layer.lifted[index(c)]));
    }
    largest = std::max(largest, nearest);
  }
  return largest / layer.atlas.diagonal;
}

double SourceGuard::stand_off(std::size_t s, const std::vector<Corners>& triangles,
                              const std::vector<std::array<int, 2>>& edges) const {
  const Layer& layer = t_.layers[s];
  const auto off = [&](const Vector3d& place, const Vector3d& chord, int near_vertex) {
    const int f = layer.atlas.locate(place.normalized(), layer.triangle[index(near_vertex)]);
    const Vector3d below = layer.atlas.position(f, layer.atlas.weights_at(place.normalized(), f));
    return std::abs((chord - below).dot(layer.atlas.normals[index(f)]));
  };
  double largest = 0;
  for (const auto& [a, b, c] : triangles) {
    if (a == t_.apex || b == t_.apex || c == t_.apex) continue;
    largest = std::max(
        largest,
        off(layer.sphere[index(a)] + layer.sphere[index(b)] + layer.sphere[index(c)],
            (layer.lifted[index(a)] + layer.lifted[index(b)] + layer.lifted[index(c)]) / 3, a));
  }
  for (const auto& [a, b] : edges) {
    largest = std::max(largest, off(layer.sphere[index(a)] + layer.sphere[index(b)],
                                    0.5 * (layer.lifted[index(a)] + layer.lifted[index(b)]), a));
  }
  return largest / layer.atlas.diagonal;
}

bool SourceGuard::stays_near(const std::vector<int>& old_triangles,
                             const std::vector<Corners>& new_triangles,
                             const std::vector<std::array<int, 2>>& new_edges) const {
  std::vector<Corners> old_corners;
  for (const int f : old_triangles) old_corners.push_back(corners_of(t_, f));
  for (std::size_t s = 0; s < t_.layers.size(); ++s) {
    const std::vector<Vector3d> around = samples(s, old_triangles, new_edges);
    const double after = largest_distance(s, around, new_triangles);
    if (after > tolerance_ && after > largest_distance(s, around, old_corners)) return false;
    const double off = stand_off(s, new_triangles, new_edges);
    if (off > tolerance_ && off > stand_off(s, old_corners, {})) return false;
  }
  return true;
}

double SourceGuard::border_distance(std::size_t s, const std::vector<int>& chain) const {
  const Layer& layer = t_.layers[s];
  const double begin = longitude(layer.sphere[index(chain.front())]);
  const auto away = [&](double angle) {
    const double turn = std::remainder(angle - begin, 2 * std::numbers::pi);
    return turn < 0 ? turn + 2 * std::numbers::pi : turn;
  };
  const double end = away(longitude(layer.sphere[index(chain.back())]));
  const auto& border = borders_[s];
  auto from = std::lower_bound(border.begin(), border.end(), std::pair(begin, -1));
  double largest = 0;
  for (std::size_t i = 0; i < border.size(); ++i, ++from) {
    if (from == border.end()) from = border.begin();
    if (away(from->first) > end) break;
    double nearest = std::numeric_limits<double>::infinity();
    for (std::size_t k = 0; k + 1 < chain.size(); ++k) {
      nearest = std::min(nearest, point_segment_distance(layer.atlas.positions[index(from->second)],
                                                         layer.lifted[index(chain[k])],
                                                         layer.lifted[index(chain[k + 1])]));
    }
    largest = std::max(largest, nearest);
  }
  return largest / layer.atlas.diagonal;
}

bool SourceGuard::border_stays_near(int u, int v) const {
  int other = -1;
  bool is_before = false;  // whether v comes before u, in the direction of growing longitude
  t_.mesh.around(u, [&](int g) {
    if (!t_.is_boundary_edge(g)) return;
    // The inner triangles lie to the left of the border's direction.
    if (t_.mesh.to(g) == v) is_before = t_.is_cap(ClosedMesh::triangle_of(g));
    if (t_.mesh.to(g) != v) other = t_.mesh.to(g);
  });
  for (std::size_t s = 0; s < t_.layers.size(); ++s) {
    const int first = is_before ? v : other, last = is_before ? other : v;
    const double after = border_distance(s, {first, last});
    if (after > tolerance_ && after > border_distance(s, {first, u, last})) return false;
  }
  return true;
}

void SourceGuard::hand_over(const std::vector<int>& old_triangles,
                            const std::vector<int>& new_triangles) {
  std::vector<std::vector<int>> loose(t_.layers.size());
  for (std::size_t s = 0; s < t_.layers.size(); ++s) {
    for (const int f : old_triangles) {
      std::vector<int>& list = below_[s][index(f)];
      loose[s].insert(loose[s].end(), list.begin(), list.end());
      list.clear();
    }
    const Layer& layer = t_.layers[s];
    for (const int v : loose[s]) {
      const Vector3d& x = layer.atlas.sphere[index(v)];
      int best = new_triangles.front();
      double best_weight = -std::numeric_limits<double>::infinity();
      for (const int f : new_triangles) {
        const auto [a, b, c] = corners_of(t_, f);
        Vector3d weights = central_weights(x, layer.sphere[index(a)], layer.sphere[index(b)],
                                           layer.sphere[index(c)]);
        const double least = weights.minCoeff() / std::max(weights.cwiseAbs().sum(), 1e-300);
        if (least <= best_weight) continue;
        best_weight = least;
        best = f;
      }
      below_[s][index(best)].push_back(v);
      points_.triangle[s][index(v)] = best;
    }
  }
}

}  // namespace morphbake
