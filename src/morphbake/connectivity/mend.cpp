#include "morphbake/connectivity/mend.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <limits>
#include <optional>
#include <utility>

#include "morphbake/connectivity/distant_triangles.h"
#include "morphbake/connectivity/relax.h"
#include "morphbake/connectivity/repair.h"
#include "morphbake/connectivity/surface_checks.h"
#include "morphbake/connectivity/triangle_cost.h"

namespace morphbake {
namespace {

constexpr int kRounds = 30;
constexpr int kPatience = 10;       // rounds that may be worse than the best
constexpr double kBadTriangle = 5;  // triangle_cost
constexpr double kHopeless = 40;    // the same, of folds and of triangles that are nearly lines
constexpr double kShare = 0.9;      // of max_error, since only some points are looked at

std::size_t index(int i) { return static_cast<std::size_t>(i); }

/// A source as the report measures it.
struct Measured {
  Mesh source;
  std::vector<char> near_cuts;
};

std::vector<Measured> measured_sources(const LayeredTriangulation& t) {
  std::vector<Measured> measured(t.layers.size());
  tbb::parallel_for(std::size_t{0}, t.layers.size(), [&](std::size_t s) {
    const SphericalMap& map = *t.layers[s].atlas.map;  // its first vertices are the source's
    measured[s].source = {map.surface.positions, map.source_triangles};
    measured[s].near_cuts = triangles_near_cuts(measured[s].source, t.observer);
  });
  return measured;
}

/// Folded and newly cut triangles of one layer, by the checks of measure_triangulation.
std::vector<int> faulty_triangles(const LayeredTriangulation& t, const SharedTriangulation& shared,
                                  std::size_t layer, const Measured& measured) {
  const Mesh remesh{shared.geometries[layer], shared.connectivity.triangles};
  std::vector<int> faulty =
      folded_triangles(measured.source, remesh, shared.on_source[layer], t.observer);
  const std::vector<std::pair<int, int>> pairs = self_intersections(remesh, t.observer);
  for (const auto& [f, g] : new_cuts(pairs, remesh, measured.source, measured.near_cuts)) {
    faulty.insert(faulty.end(), {f, g});
  }
  const std::vector<int> slots = surface_triangles(t);
  for (int& f : faulty) f = slots[index(f)];
  return faulty;
}

/// Folded, degenerate, newly cut and distant triangles of all layers; some several times.
std::vector<int> broken_triangles(const LayeredTriangulation& t, const SourcePoints& points,
                                  double max_error, const std::vector<Measured>& measured) {
  const SharedTriangulation shared = shared_triangulation(t);
  std::vector<std::vector<int>> found(t.layers.size());
  tbb::parallel_for(std::size_t{0}, t.layers.size(), [&](std::size_t s) {
    found[s] = faulty_triangles(t, shared, s, measured[s]);
    const std::vector<int> distant = distant_triangles(t, s, points, kShare * max_error);
    found[s].insert(found[s].end(), distant.begin(), distant.end());
  });
  std::vector<int> broken;
  for (const std::vector<int>& of_layer : found) {
    broken.insert(broken.end(), of_layer.begin(), of_layer.end());
  }
  for (int f = 0; f < t.mesh.triangle_slots(); ++f) {
    int folds = 0;
    if (t.mesh.has_triangle(f) && triangle_cost(t, f, folds) > kHopeless) broken.push_back(f);
  }
  return broken;
}

/// The corners of triangles and what is around them.
Patch patch_around(const LayeredTriangulation& t, const std::vector<int>& triangles) {
  Patch patch{std::vector<char>(index(t.mesh.vertex_slots()), 0)};
  for (const int f : triangles) {
    for (int k = 0; k < 3; ++k) {
      t.mesh.around(t.mesh.from(3 * f + k),
                    [&](int h) { patch.vertices[index(t.mesh.to(h))] = 1; });
    }
  }
  return patch;
}

/// Halves the edge of each triangle that is furthest from a source.
void split_worst_edges(LayeredTriangulation& t, const std::vector<int>& triangles,
                       int vertex_limit) {
  for (const int f : triangles) {
    if (!t.mesh.has_triangle(f) || t.vertex_count() >= vertex_limit) continue;
    double worst = 0;
    int edge = -1;
    for (int h = 3 * f; h < 3 * f + 3; ++h) {
      for (const Layer& layer : t.layers) {
        const double deviation =
            middle_deviation(layer, t.mesh.from(h), t.mesh.to(h), Eigen::Vector3d::Zero());
        if (deviation <= worst) continue;
        worst = deviation;
        edge = h;
      }
    }
    if (edge >= 0) split_edge_at(t, edge, places_on_edge(t, edge, 0.5));
  }
}

/// Whether most of a source cuts itself: then no triangulation of it can be without cuts, and
/// looking for them takes the square of its size.
bool is_tangled(const Measured& measured) {
  const auto count = std::count(measured.near_cuts.begin(), measured.near_cuts.end(), char{1});
  return 2 * count > static_cast<std::ptrdiff_t>(measured.near_cuts.size());
}

}  // namespace

void mend(LayeredTriangulation& t, SourcePoints& points, double max_error, int vertex_limit) {
  const double tolerance = 0.5 * max_error;
  const std::vector<Measured> measured = measured_sources(t);
  if (std::any_of(measured.begin(), measured.end(), is_tangled)) return;
  std::optional<LayeredTriangulation> best;
  std::size_t fewest = std::numeric_limits<std::size_t>::max();
  int since_best = 0;
  for (int round = 0; round < kRounds; ++round) {
    stop_if_cancelled(t.observer);
    const std::vector<int> broken = broken_triangles(t, points, max_error, measured);
    ++since_best;
    if (broken.size() < fewest) {
      best = t;
      fewest = broken.size();
      since_best = 0;
    }
    if (broken.empty() || since_best == kPatience) break;
    const Patch patch = patch_around(t, broken);
    split_worst_edges(t, broken, vertex_limit);
    flip_edges(t, tolerance, patch);
    // When relaxing does not help, or brings back what it mends, every other round does without.
    if (since_best < 2 || since_best % 2 == 1) relax(t, {.sweeps = 2, .patch = patch});
    flip_edges(t, tolerance, patch);
    repair(t, points, tolerance, kBadTriangle, patch);
  }
  t = std::move(*best);
}

}  // namespace morphbake
