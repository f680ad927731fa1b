#include "morphbake/connectivity/repair.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "morphbake/connectivity/point_distance.h"
#include "morphbake/correspondence/triangle_energy.h"

namespace morphbake {
namespace {

using Eigen::Vector3d;

std::size_t index(int i) { return static_cast<std::size_t>(i); }

Vector3d squared_lengths(const Layer& layer, int a, int b, int c) {
  const Vector3d &pa = layer.lifted[index(a)], &pb = layer.lifted[index(b)],
                 &pc = layer.lifted[index(c)];
  return {(pb - pc).squaredNorm(), (pc - pa).squaredNorm(), (pa - pb).squaredNorm()};
}

/// How bad a triangle is: about 1 + 1 a layer for a good one.
struct Badness {
  double sum = 0;
  int folds = 0;
};

Badness badness(const LayeredTriangulation& t, int a, int b, int c) {
  Badness bad;
  Vector3d mean = Vector3d::Zero();
  for (const Layer& layer : t.layers) mean += squared_lengths(layer, a, b, c);
  const RestTriangle rest =
      rest_triangle(mean / static_cast<double>(t.layers.size()), {1e-3, 1e-14});
  for (const Layer& layer : t.layers) {
    const Vector3d normal = area_normal(layer, a, b, c);
    const double twice_area = normal.norm();
    const Vector3d lengths = squared_lengths(layer, a, b, c);
    bad.sum += std::min(1e4, lengths.sum() / (2 * std::sqrt(3.0) * std::max(twice_area, 1e-300)));
    const double q = 0.5 * rest.cotangents.dot(lengths);
    const double ratio = 2 * rest.area / std::max(twice_area, 1e-300);
    // Twice against the mean is about once between two sources.
    bad.sum += std::min(1e4, q * (1 + ratio * ratio) / (4 * rest.area));
    const double cosine = normal_below(layer, a, b, c).dot(normal) / (twice_area + 1e-300);
    if (cosine < 0) {
      bad.sum += 20;
      ++bad.folds;
    } else if (cosine < 0.3) {
      bad.sum += (0.3 - cosine) * 10;
    }
  }
  return bad;
}

Badness badness(const LayeredTriangulation& t, int f) {
  if (t.is_cap(f)) return {};
  return badness(t, t.mesh.from(3 * f), t.mesh.from(3 * f + 1), t.mesh.from(3 * f + 2));
}

bool try_flip(LayeredTriangulation& t, int h, double tolerance) {
  if (!can_flip(t, h)) return false;
  const int a = t.mesh.from(h), b = t.mesh.to(h);
  const int c = t.mesh.apex(h), d = t.mesh.apex(t.mesh.opposite(h));
  for (const Layer& layer : t.layers) {
    const double before =
        middle_deviation(layer, a, b, area_normal(layer, a, b, c) + area_normal(layer, b, a, d));
    const double after =
        middle_deviation(layer, c, d, area_normal(layer, a, d, c) + area_normal(layer, d, b, c));
    if (after > tolerance && after > before) return false;
  }
  const double before = badness(t, a, b, c).sum + badness(t, b, a, d).sum;
  const double after = badness(t, a, d, c).sum + badness(t, d, b, c).sum;
  if (!(after < before - 0.3)) return false;
  t.mesh.flip(h);
  return true;
}

bool try_collapse(LayeredTriangulation& t, int h, double tolerance) {
  if (!can_collapse(t, h)) return false;
  const int u = t.mesh.from(h), v = t.mesh.to(h);
  double before = 0, after = 0, worst_before = 0, worst_after = 0;
  int count_before = 0, count_after = 0;
  std::vector<std::array<int, 2>> outer;
  bool ok = true;
  t.mesh.around(u, [&](int g) {
    const int f = ClosedMesh::triangle_of(g);
    const int a = t.mesh.to(g), b = t.mesh.apex(g);
    if (t.is_cap(f)) {
      if (a == v || b == v) return;
      const int x = a == t.apex ? b : a;
      for (const Layer& layer : t.layers) {
        ok = ok &&
             point_segment_distance(layer.lifted[index(u)], layer.lifted[index(v)],
                                    layer.lifted[index(x)]) <= tolerance * layer.atlas.diagonal;
      }
      return;
    }
    const double old = badness(t, f).sum;
    before += old;
    ++count_before;
    worst_before = std::max(worst_before, old);
    if (a == v || b == v) return;
    outer.push_back({a, b});
    const double now = badness(t, v, a, b).sum;
    after += now;
    ++count_after;
    worst_after = std::max(worst_after, now);
  });
  if (!ok || count_after == 0) return false;
  if (!(worst_after < 0.8 * worst_before && after / count_after < before / count_before))
    return false;
  for (const Layer& layer : t.layers) {
    double nearest = std::numeric_limits<double>::infinity();
    for (const auto& [a, b] : outer) {
      nearest = std::min(nearest,
                         point_triangle_distance(layer.lifted[index(u)], layer.lifted[index(v)],
                                                 layer.lifted[index(a)], layer.lifted[index(b)]));
    }
    if (nearest > tolerance * layer.atlas.diagonal) return false;
  }
  collapse(t, h);
  return true;
}

bool try_move(LayeredTriangulation& t, int v, std::mt19937& random) {
  if (t.is_fixed[index(v)]) return false;
  bool moved = false;
  std::vector<std::array<int, 2>> ring;
  t.mesh.around(v, [&](int h) { ring.push_back({t.mesh.to(h), t.mesh.apex(h)}); });
  const auto star_badness = [&] {
    double sum = 0;
    t.mesh.around(v, [&](int h) { sum += badness(t, ClosedMesh::triangle_of(h)).sum; });
    return sum;
  };
  const auto uniform = [&] { return (random() >> 5) * (1.0 / 134217728.0); };
  double best = star_badness();
  for (Layer& layer : t.layers) {
    const Vector3d place = layer.sphere[index(v)];
    Vector3d best_place = place;
    Vector3d best_lifted = layer.lifted[index(v)];
    int best_triangle = layer.triangle[index(v)];
    const double start = best;
    for (int i = 0; i < 24; ++i) {
      Vector3d target = Vector3d::Zero();
      double weight = 0;
      for (const auto& [a, b] : ring) {
        if (a == t.apex || (t.on_boundary[index(v)] && !t.on_boundary[index(a)])) continue;
        const double w = -std::log(uniform() + 1e-12);
        target += w * layer.sphere[index(a)];
        weight += w;
      }
      if (weight == 0) break;
      const double u = std::pow(uniform(), 1.5);
      const Vector3d next = ((1 - u) * place + u * target / weight).normalized();
      bool ok = true;
      for (const auto& [a, b] : ring) {
        ok = ok && is_positive(next, layer.sphere[index(a)], layer.sphere[index(b)]);
      }
      if (!ok) continue;
      lift(layer, v, next, best_triangle);
      const double now = star_badness();
      if (now < best - 1e-3) {
        best = now;
        best_place = next;
        best_lifted = layer.lifted[index(v)];
        best_triangle = layer.triangle[index(v)];
      }
    }
    layer.sphere[index(v)] = best_place;
    layer.lifted[index(v)] = best_lifted;
    layer.triangle[index(v)] = best_triangle;
    moved |= best < start - 1e-3;
  }
  return moved;
}

}  // namespace

int count_folds(const LayeredTriangulation& t) {
  int folds = 0;
  for (int f = 0; f < t.mesh.triangle_slots(); ++f) {
    if (t.mesh.has_triangle(f)) folds += badness(t, f).folds;
  }
  return folds;
}

int repair(LayeredTriangulation& t, double tolerance, double threshold) {
  std::mt19937 random(1);
  std::vector<double> bad(index(t.mesh.triangle_slots()), 0);
  tbb::parallel_for(0, t.mesh.triangle_slots(), [&](int f) {
    if (t.mesh.has_triangle(f)) bad[index(f)] = badness(t, f).sum;
  });
  int count = 0;
  for (int f = 0; f < static_cast<int>(bad.size()); ++f) {
    if (!(bad[index(f)] > threshold) || !t.mesh.has_triangle(f)) continue;
    if (!(badness(t, f).sum > threshold)) continue;
    ++count;
    const std::array corners{t.mesh.from(3 * f), t.mesh.from(3 * f + 1), t.mesh.from(3 * f + 2)};
    bool done = false;
    for (int k = 0; k < 3 && !done; ++k) done = try_flip(t, 3 * f + k, tolerance);
    for (int k = 0; k < 3 && !done; ++k) {
      const int h = 3 * f + k;
      done = try_collapse(t, h, tolerance) || try_collapse(t, t.mesh.opposite(h), tolerance);
    }
    for (std::size_t k = 0; k < 3 && !done; ++k) {
      if (t.mesh.has_vertex(corners[k])) try_move(t, corners[k], random);
    }
  }
  return count;
}

}  // namespace morphbake
