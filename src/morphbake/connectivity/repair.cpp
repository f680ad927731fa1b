#include "morphbake/connectivity/repair.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <random>

#include "morphbake/connectivity/source_guard.h"
#include "morphbake/connectivity/triangle_cost.h"
#include "morphbake/correspondence/triangle_energy.h"

namespace morphbake {
namespace {

using Eigen::Vector3d;

constexpr int kTries = 2;     // of a triangle until something around it changes
constexpr int kStride = 256;  // triangles between two looks whether to stop
constexpr int kMoves = 24;    // places tried for a vertex on each layer

std::size_t index(int i) { return static_cast<std::size_t>(i); }

/// What is around a vertex that may move.
struct Star {
  std::vector<int> triangles;
  std::vector<Corners> ring;                       ///< one a triangle, the vertex first
  std::vector<std::array<int, 2>> edges;           ///< from the vertex to its ring
  std::vector<std::vector<LayerTriangle>> shapes;  ///< triangle, layer
};

/// Repairs one triangulation; keeps which source vertices lie under which triangle.
class Repair {
 public:
  Repair(LayeredTriangulation& t, SourcePoints& points, double tolerance)
      : t_(t), tolerance_(tolerance), guard_(t, points, tolerance) {
    costs_.resize(index(t.mesh.triangle_slots()), 0);
    failures_.resize(costs_.size(), 0);
    tbb::parallel_for(0, t.mesh.triangle_slots(), [&](int f) {
      if (f % kStride == 0) stop_if_cancelled(t_.observer);
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
      stop_if_cancelled(t_.observer);
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

  void update(const std::vector<int>& old_triangles, const std::vector<int>& new_triangles) {
    guard_.hand_over(old_triangles, new_triangles);
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
    if (!(after < 0.98 * before) || !guard_.stays_near(old, now, {{c, d}})) return false;
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
    if (!guard_.stays_near(old, now, edges)) return false;
    if (t_.on_boundary[index(u)] && !guard_.border_stays_near(u, v)) return false;
    collapse(t_, h);
    update(old, kept);
    return true;
  }

  bool try_move(int v) {
    if (t_.is_fixed[index(v)] || t_.on_boundary[index(v)] || t_.is_on_hard_edge(v)) return false;
    Star star = star_of(v);
    bool moved = false;
    for (std::size_t s = 0; s < t_.layers.size(); ++s) moved |= move_in(s, v, star);
    return moved;
  }

  Star star_of(int v) const {
    Star star;
    t_.mesh.around(v, [&](int h) {
      const int a = t_.mesh.to(h), b = t_.mesh.apex(h);
      star.triangles.push_back(ClosedMesh::triangle_of(h));
      star.ring.push_back({v, a, b});
      star.edges.push_back({v, a});
      std::vector<LayerTriangle>& layers = star.shapes.emplace_back();
      for (const Layer& layer : t_.layers) layers.push_back(layer_triangle(layer, v, a, b));
    });
    return star;
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

  /// Tries to move a vertex on one layer; keeps the star's shapes up to date.
  bool move_in(std::size_t s, int v, Star& star) {
    const std::vector<Corners>& ring = star.ring;
    Layer& layer = t_.layers[s];
    const Vector3d place = layer.sphere[index(v)], lifted = layer.lifted[index(v)];
    const int triangle = layer.triangle[index(v)];
    double best = 0.98 * sum_of_squares(star.shapes);
    bool moved = false;
    const std::vector<Vector3d> around = guard_.samples(s, star.triangles, {});
    const double bound = std::max(tolerance_, guard_.largest_distance(s, around, ring));
    const double off_bound = std::max(tolerance_, guard_.stand_off(s, ring, star.edges));
    Vector3d best_place;
    std::vector<std::vector<LayerTriangle>> best_shapes = star.shapes, tried = star.shapes;
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
      if (guard_.largest_distance(s, around, ring) > bound ||
          guard_.largest_distance(s, guard_.samples(s, {}, star.edges), ring) > bound ||
          guard_.stand_off(s, ring, star.edges) > off_bound) {
        continue;
      }
      best = now;
      best_place = next;
      best_shapes = tried;
      moved = true;
    }
    if (moved) {
      lift(layer, v, best_place, triangle);
      star.shapes = best_shapes;
      update(star.triangles, star.triangles);
    } else {
      layer.sphere[index(v)] = place;
      layer.lifted[index(v)] = lifted;
      layer.triangle[index(v)] = triangle;
    }
    return moved;
  }

  LayeredTriangulation& t_;
  double tolerance_;
  SourceGuard guard_;
  std::vector<double> costs_;  ///< one a triangle slot
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
