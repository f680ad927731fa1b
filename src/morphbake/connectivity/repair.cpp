#include "morphbake/connectivity/repair.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>

#include "morphbake/connectivity/point_distance.h"
#include "morphbake/connectivity/triangle_cost.h"
#include "morphbake/correspondence/triangle_energy.h"

namespace morphbake {
namespace {

using Corners = std::array<int, 3>;
using Eigen::Vector3d;

constexpr int kTries = 2;   // of a triangle until something around it changes
constexpr int kMoves = 24;  // places tried for a vertex on each layer

std::size_t index(int i) { return static_cast<std::size_t>(i); }

Corners corners_of(const LayeredTriangulation& t, int f) {
  return {t.mesh.from(3 * f), t.mesh.from(3 * f + 1), t.mesh.from(3 * f + 2)};
}

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

/// Repairs one triangulation; keeps which source vertices lie under which triangle.
class Repair {
 public:
  Repair(LayeredTriangulation& t, SourcePoints& points, double tolerance)
      : t_(t), points_(points), tolerance_(tolerance), below_(t.layers.size()) {
    for (std::size_t s = 0; s < t.layers.size(); ++s) {
      borders_.push_back(border_points(t.layers[s].atlas));
      below_[s].resize(index(t.mesh.triangle_slots()));
      for (const int v : points.order[s]) {
        if (t.layers[s].atlas.map->on_boundary[index(v)]) continue;
        below_[s][index(points.triangle[s][index(v)])].push_back(v);
      }
    }
    costs_.resize(index(t.mesh.triangle_slots()), 0);
    failures_.resize(costs_.size(), 0);
    tbb::parallel_for(0, t.mesh.triangle_slots(), [&](int f) {
      int folds = 0;
      if (t_.mesh.has_triangle(f)) costs_[index(f)] = triangle_cost(t_, f, folds);
    });
  }

  Repaired pass(double threshold, const Patch& patch) {
    Repaired repaired;
    std::vector<std::pair<double, int>> bad;
    for (int f = 0; f < static_cast<int>(costs_.size()); ++f) {
      if (t_.mesh.has_triangle(f) && costs_[index(f)] > threshold && touches(patch, f)) {
        bad.emplace_back(-costs_[index(f)], f);
      }
    }
    std::sort(bad.begin(), bad.end());
    repaired.bad = static_cast<int>(bad.size());
    for (const auto& [cost, f] : bad) {
      if (!t_.mesh.has_triangle(f) || !(costs_[index(f)] > threshold)) continue;
      if (failures_[index(f)] >= kTries) continue;
      const int changed = better(f);
      repaired.changes += changed;
      if (!changed) ++failures_[index(f)];
    }
    return repaired;
  }

 private:
  bool touches(const Patch& patch, int f) const {
    const Corners corners = corners_of(t_, f);
    return std::any_of(corners.begin(), corners.end(), [&](int v) { return patch.has(v); });
  }

  bool better(int f) {
    const Corners corners = corners_of(t_, f);
    for (int k = 0; k < 3; ++k) {
      if (try_flip(3 * f + k)) return true;
    }
    for (int k = 0; k < 3; ++k) {
      const int h = 3 * f + k;
      if (try_collapse(h) || try_collapse(t_.mesh.opposite(h))) return true;
    }
    bool moved = false;
    for (const int v : corners) moved |= try_move(v);
    return moved;
  }

  /// Vertices and edge middles of a source around some triangles.
  std::vector<Vector3d> samples(std::size_t s, const std::vector<int>& triangles,
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

  double largest_distance(std::size_t s, const std::vector<Vector3d>& from,
                          const std::vector<Corners>& triangles) const {
    const Layer& layer = t_.layers[s];
    double largest = 0;
    for (const Vector3d& p : from) {
      double nearest = std::numeric_limits<double>::infinity();
      for (const auto& [a, b, c] : triangles) {
        nearest = std::min(
            nearest, point_triangle_distance(p, layer.lifted[index(a)], layer.lifted[index(b)],
                                             layer.lifted[index(c)]));
      }
      largest = std::max(largest, nearest);
    }
    return largest / layer.atlas.diagonal;
  }

  /// How far the middles of new triangles and edges stand off the source, seen along its normal.
  double stand_off(std::size_t s, const std::vector<Corners>& triangles,
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

  /// Whether the sources stay as near to new triangles as they were to old ones, or within the
  /// tolerance.
  bool stays_near(const std::vector<int>& old_triangles, const std::vector<Corners>& new_triangles,
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

  /// Largest distance of a source's border between two border vertices from a chain of them.
  double border_distance(std::size_t s, const std::vector<int>& chain) const {
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
        nearest =
            std::min(nearest, point_segment_distance(layer.atlas.positions[index(from->second)],
                                                     layer.lifted[index(chain[k])],
                                                     layer.lifted[index(chain[k + 1])]));
      }
      largest = std::max(largest, nearest);
    }
    return largest / layer.atlas.diagonal;
  }

  /// Whether the borders stay near when border vertex u goes into its neighbour v.
  bool border_stays_near(int u, int v) const {
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

  double cost_of(const Corners& corners) const {
    if (t_.apex >= 0 && std::find(corners.begin(), corners.end(), t_.apex) != corners.end())
      return 0;
    std::vector<LayerTriangle> layers;
    for (const Layer& layer : t_.layers) {
      layers.push_back(layer_triangle(layer, corners[0], corners[1], corners[2]));
    }
    int folds = 0;
    return triangle_cost(layers, folds);
  }

  /// Hands the source vertices below old triangles to those that are there now.
  void update(const std::vector<int>& old_triangles, const std::vector<int>& new_triangles) {
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
    for (const int f : new_triangles) {
      costs_[index(f)] = cost_of(corners_of(t_, f));
      failures_[index(f)] = 0;
    }
  }

  bool try_flip(int h) {
    if (!can_flip(t_, h)) return false;
    const int o = t_.mesh.opposite(h);
    const int a = t_.mesh.from(h), b = t_.mesh.to(h), c = t_.mesh.apex(h), d = t_.mesh.apex(o);
    const std::vector<int> old{ClosedMesh::triangle_of(h), ClosedMesh::triangle_of(o)};
    const std::vector<Corners> now{{a, d, c}, {d, b, c}};
    double before = 0, after = 0;
    for (std::size_t i = 0; i < 2; ++i) {
      before += std::pow(costs_[index(old[i])], 2);
      after += std::pow(cost_of(now[i]), 2);
    }
    if (!(after < 0.98 * before) || !stays_near(old, now, {{c, d}})) return false;
    t_.mesh.flip(h);
    update(old, old);
    return true;
  }

  bool try_collapse(int h) {
    const int u = t_.mesh.from(h), v = t_.mesh.to(h);
    if (!can_collapse(t_, h)) return false;
    std::vector<int> old, kept;
    std::vector<Corners> now;
    std::vector<std::array<int, 2>> edges;
    double before = 0, after = 0, worst_before = 0, worst_after = 0;
    t_.mesh.around(u, [&](int g) {
      const int f = ClosedMesh::triangle_of(g), a = t_.mesh.to(g), b = t_.mesh.apex(g);
      old.push_back(f);
      before += std::pow(costs_[index(f)], 2);
      worst_before = std::max(worst_before, costs_[index(f)]);
      if (a == v || b == v) return;
      kept.push_back(f);
      now.push_back({v, a, b});
      if (a != t_.apex && !(t_.on_boundary[index(u)] && t_.on_boundary[index(a)])) {
        edges.push_back({v, a});
      }
      const double cost = cost_of(now.back());
      after += cost * cost;
      worst_after = std::max(worst_after, cost);
    });
    if (!(after < before && worst_after < 0.9 * worst_before)) return false;
    if (!stays_near(old, now, edges)) return false;
    if (t_.on_boundary[index(u)] && !border_stays_near(u, v)) return false;
    collapse(t_, h);
    update(old, kept);
    return true;
  }

  bool try_move(int v) {
    if (t_.is_fixed[index(v)] || t_.on_boundary[index(v)] || t_.is_on_hard_edge(v)) return false;
    std::vector<int> star;
    std::vector<Corners> ring;
    std::vector<std::array<int, 2>> edges;
    std::vector<std::vector<LayerTriangle>> shapes;
    t_.mesh.around(v, [&](int h) {
      star.push_back(ClosedMesh::triangle_of(h));
      ring.push_back({v, t_.mesh.to(h), t_.mesh.apex(h)});
      edges.push_back({v, t_.mesh.to(h)});
      std::vector<LayerTriangle>& layers = shapes.emplace_back();
      for (const Layer& layer : t_.layers) {
        layers.push_back(layer_triangle(layer, ring.back()[0], ring.back()[1], ring.back()[2]));
      }
    });
    bool moved = false;
    for (std::size_t s = 0; s < t_.layers.size(); ++s)
      moved |= move_in(s, v, star, ring, edges, shapes);
    return moved;
  }

  double sum_of_squares(const std::vector<std::vector<LayerTriangle>>& shapes) const {
    double sum = 0;
    int folds = 0;
    for (const std::vector<LayerTriangle>& layers : shapes) {
      sum += std::pow(triangle_cost(layers, folds), 2);
    }
    return sum;
  }

  /// A random place between a vertex and its ring.
  Vector3d random_place(const Layer& layer, int v, const std::vector<Corners>& ring) {
    // Not std's distributions, whose numbers differ from library to library.
    const auto uniform = [&] { return static_cast<double>(random_() >> 5) / 134217728; };
    Vector3d target = Vector3d::Zero();
    double weight = 0;
    for (const Corners& corners : ring) {
      const double w = -std::log(uniform() + 1e-12);
      target += w * layer.sphere[index(corners[1])];
      weight += w;
    }
    const double u = std::pow(uniform(), 1.5);
    return ((1 - u) * layer.sphere[index(v)] + u * target / weight).normalized();
  }

  bool move_in(std::size_t s, int v, const std::vector<int>& star, const std::vector<Corners>& ring,
               const std::vector<std::array<int, 2>>& edges,
               std::vector<std::vector<LayerTriangle>>& shapes) {
    Layer& layer = t_.layers[s];
    const Vector3d place = layer.sphere[index(v)], lifted = layer.lifted[index(v)];
    const int triangle = layer.triangle[index(v)];
    double best = 0.98 * sum_of_squares(shapes);
    bool moved = false;
    const std::vector<Vector3d> around = samples(s, star, {});
    const double bound = std::max(tolerance_, largest_distance(s, around, ring));
    const double off_bound = std::max(tolerance_, stand_off(s, ring, edges));
    Vector3d best_place;
    std::vector<std::vector<LayerTriangle>> best_shapes = shapes, tried = shapes;
    for (int i = 0; i < kMoves; ++i) {
      layer.sphere[index(v)] = place;
      const Vector3d next = random_place(layer, v, ring);
      const bool is_open = std::all_of(ring.begin(), ring.end(), [&](const Corners& c) {
        return is_positive(next, layer.sphere[index(c[1])], layer.sphere[index(c[2])]);
      });
      if (!is_open) continue;
      lift(layer, v, next, triangle);
      for (std::size_t j = 0; j < ring.size(); ++j) {
        tried[j][s] = layer_triangle(layer, v, ring[j][1], ring[j][2]);
      }
      const double now = sum_of_squares(tried);
      if (!(now < best)) continue;
      if (largest_distance(s, around, ring) > bound ||
          largest_distance(s, samples(s, {}, edges), ring) > bound ||
          stand_off(s, ring, edges) > off_bound) {
        continue;
      }
      best = now;
      best_place = next;
      best_shapes = tried;
      moved = true;
    }
    if (moved) {
      lift(layer, v, best_place, triangle);
      shapes = best_shapes;
      update(star, star);
    } else {
      layer.sphere[index(v)] = place;
      layer.lifted[index(v)] = lifted;
      layer.triangle[index(v)] = triangle;
    }
    return moved;
  }

  LayeredTriangulation& t_;
  SourcePoints& points_;
  double tolerance_;
  std::vector<std::vector<std::vector<int>>> below_;          ///< layer, triangle: source vertices
  std::vector<std::vector<std::pair<double, int>>> borders_;  ///< one a layer
  std::vector<double> costs_;                                 ///< one a triangle slot
  std::vector<int> failures_;  ///< one a triangle slot: tries in vain since something changed
  std::mt19937 random_{1};
};

}  // namespace

Repaired repair(LayeredTriangulation& t, SourcePoints& points, double tolerance, double threshold,
                const Patch& patch) {
  constexpr int kPasses = 12;
  source_errors(t, points);  // finds where the source vertices lie now
  Repair repair(t, points, tolerance);
  Repaired all;
  for (int pass = 0; pass < kPasses; ++pass) {
    const Repaired one = repair.pass(threshold, patch);
    all.bad = one.bad;
    all.changes += one.changes;
    if (one.changes == 0) break;
  }
  return all;
}

}  // namespace morphbake
