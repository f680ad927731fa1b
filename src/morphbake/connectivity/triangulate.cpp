#include <algorithm>
#include <cmath>

#include "morphbake/connectivity/layered_triangulation.h"
#include "morphbake/connectivity/mend.h"
#include "morphbake/connectivity/refine.h"
#include "morphbake/connectivity/relax.h"
#include "morphbake/connectivity/repair.h"
#include "morphbake/connectivity/shared_triangulation.h"
#include "morphbake/connectivity/trace_hard_edges.h"

// Tried and dropped: refining in equal steps without waiting for the error to follow (folds of
// limbs that are found late stay: mean distortion of two bodies 1.20 instead of 1.13); repairing
// every third round only (folds spoil the relaxation: 1.16); holding vertices at features from the
// start (1.17). The mean of many layers from the start: it moves slowly while all are far from one
// another (8 bent cats, 30 first sweeps: mean distortion up to 1.13 in 35 s, not 1.08 in 24 s).

namespace morphbake {
namespace {

constexpr int kCoarseVertices = 900;
constexpr double kCoarseTolerance = 0.016;  // fraction of the diagonal, of the first triangulation
constexpr double kStep = 0.7;               // of the tolerance, from level to level
constexpr int kTriesOfLevel = 2;            // rounds until the error has to have followed
constexpr int kRounds = 60;
constexpr double kMeanTolerance = 0.008;  // of more than two layers: from here they meet midway
constexpr double kFineTolerance = 0.003;  // from here vertices at features stay
constexpr double kFeatureCosine = 0.85;
constexpr int kManyVertices = 3000;  // below, sweeps are cheap and do nearly all of the work
constexpr double kBadTriangle = 8;   // triangle_cost
constexpr double kBadTriangleAtEnd = 5;
constexpr int kFewChanges = 10;  // of a round, which end the refinement
constexpr int kLastRounds = 5;   // at the last tolerance; what is left then is for mend

void relax_with_flips(LayeredTriangulation& t, double tolerance) {
  const int sweeps = t.vertex_count() < kManyVertices ? 20 : 4;
  RelaxOptions options;
  options.sweeps = 2;
  if (t.layers.size() > 2 && tolerance > kMeanTolerance) options.rest = Rest::First;
  options.feature_cosine = tolerance > kFineTolerance ? -1 : kFeatureCosine;
  for (int sweep = 0; sweep < sweeps; sweep += 2) {
    relax(t, options);
    if (sweep % 6 == 0) flip_edges(t, tolerance);
  }
}

/// A coarse triangulation that meets all sources roughly and differs little between them.
LayeredTriangulation first_triangulation(const std::vector<SphericalMap>& maps,
                                         SourcePoints& points, int vertex_limit,
                                         const Observer& observer) {
  LayeredTriangulation t =
      coarse_triangulation(maps, std::min(kCoarseVertices, vertex_limit), observer);
  points = source_points(t);
  for (int round = 0; round < 3; ++round) {
    split_long_edges(t, 0.1, vertex_limit);
    insert_boundary_points(t, kCoarseTolerance, vertex_limit);
    insert_worst_points(t, points, kCoarseTolerance, vertex_limit);
    split_deviating_edges(t, kCoarseTolerance, vertex_limit);
    for (int k = 0; k < 3; ++k) flip_edges(t, kCoarseTolerance);
  }
  repair(t, points, kCoarseTolerance, kBadTriangle);
  constexpr int kSweeps = 120;
  const Rest rest = t.layers.size() > 2 ? Rest::First : Rest::Mean;
  for (int sweep = 0; sweep < kSweeps; ++sweep) {
    relax(t, {.rest = rest});
    if (sweep % 3 == 2) flip_edges(t, kCoarseTolerance);
    if (sweep % 10 == 9) repair(t, points, kCoarseTolerance, kBadTriangle);
  }
  return t;
}

/// Adds vertices where a source is further away than `tolerance`.
Pass refine_once(LayeredTriangulation& t, SourcePoints& points, double tolerance, double length,
                 int vertex_limit) {
  Pass all = split_long_edges(t, length, vertex_limit);
  all.changes += insert_boundary_points(t, tolerance, vertex_limit).changes;
  const Pass inserted = insert_worst_points(t, points, tolerance, vertex_limit);
  all.error = inserted.error;
  all.changes += inserted.changes;
  all.changes += split_deviating_edges(t, tolerance, vertex_limit).changes;
  for (int k = 0; k < 3; ++k) flip_edges(t, tolerance);
  return all;
}

}  // namespace

SharedTriangulation triangulate(const std::vector<SphericalMap>& maps, const RemeshOptions& options,
                                const Observer& observer) {
  const int limit = options.max_vertices;
  // Half of what is asked: between the points that are looked at surfaces are further apart.
  const double goal = 0.5 * options.max_error;
  SourcePoints points;
  LayeredTriangulation t = first_triangulation(maps, points, limit, observer);
  double tolerance = kCoarseTolerance;
  double length = 0.2;
  bool has_followed = true;
  int tries = 0;
  int last_rounds = 0;
  for (int round = 0; round < kRounds; ++round) {
    advance(observer, {"triangulation", round, kRounds});
    const bool is_last = tolerance <= goal;
    if (has_followed) tolerance = std::max(goal, kStep * tolerance);
    const Pass pass = refine_once(t, points, tolerance, length, limit);
    repair(t, points, tolerance, kBadTriangle);
    if (!is_last) relax_with_flips(t, tolerance);
    has_followed = pass.error < 2 * tolerance || ++tries > kTriesOfLevel;
    if (has_followed) tries = 0;
    length = options.sizing == Sizing::Uniform && is_last
                 ? options.target_edge_length
                 : std::max(options.target_edge_length, kStep * length);
    const bool is_fine = length <= options.target_edge_length;
    last_rounds += is_last && is_fine;
    if (last_rounds > 0 && (pass.changes < kFewChanges || last_rounds == kLastRounds)) break;
    if (t.vertex_count() >= limit) break;
  }
  repair(t, points, goal, kBadTriangleAtEnd);
  const int missed = trace_hard_edges(t, limit);
  if (!t.hard_edges.empty()) repair(t, points, goal, kBadTriangleAtEnd);
  mend(t, points, options.max_error, limit);
  advance(observer, {"triangulation", kRounds, kRounds});
  SharedTriangulation shared = shared_triangulation(t);
  shared.rounded_hard_edges = missed;
  shared.is_full = shared.connectivity.vertex_count >= limit;
  return shared;
}

}  // namespace morphbake
