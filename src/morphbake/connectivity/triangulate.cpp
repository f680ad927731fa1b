#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>

#include "morphbake/connectivity/refine.h"
#include "morphbake/connectivity/relax.h"
#include "morphbake/connectivity/repair.h"
#include "morphbake/connectivity/shared_triangulation.h"

namespace morphbake {
namespace {

std::size_t index(int i) { return static_cast<std::size_t>(i); }

SharedTriangulation finish(const LayeredTriangulation& t) {
  SharedTriangulation shared;
  std::vector<int> number(index(t.mesh.vertex_slots()), -1);
  std::vector<int> living;
  for (int v = 0; v < t.mesh.vertex_slots(); ++v) {
    if (!t.mesh.has_vertex(v) || v == t.apex) continue;
    number[index(v)] = static_cast<int>(living.size());
    living.push_back(v);
  }
  shared.connectivity.vertex_count = static_cast<int>(living.size());
  std::vector<int> corners;
  for (int f = 0; f < t.mesh.triangle_slots(); ++f) {
    if (!t.mesh.has_triangle(f) || t.is_cap(f)) continue;
    for (int k = 0; k < 3; ++k) corners.push_back(number[index(t.mesh.from(3 * f + k))]);
  }
  shared.connectivity.triangles =
      Eigen::Map<const Triangles>(corners.data(), static_cast<Eigen::Index>(corners.size() / 3), 3);
  for (const Layer& layer : t.layers) {
    const SphericalMap& map = *layer.atlas.map;
    Positions& geometry = shared.geometries.emplace_back(shared.connectivity.vertex_count, 3);
    Positions& sphere = shared.sphere.emplace_back(shared.connectivity.vertex_count, 3);
    std::vector<SurfacePoint>& on_source = shared.on_source.emplace_back();
    for (int i = 0; i < shared.connectivity.vertex_count; ++i) {
      const int v = living[index(i)];
      geometry.row(i) =
          (layer.lifted[index(v)] / layer.atlas.scale + layer.atlas.centre).transpose();
      sphere.row(i) = layer.sphere[index(v)];
      (void)map;
      on_source.push_back({layer.triangle[index(v)], Eigen::Vector3d::Zero()});
    }
  }
  for (const int v : living) shared.on_boundary.push_back(t.on_boundary[index(v)]);
  return shared;
}

}  // namespace

SharedTriangulation triangulate(const std::vector<SphericalMap>& maps, const RemeshOptions& options,
                                const Observer&) {
  const char* ev = std::getenv("V");
  const bool verbose = ev != nullptr;
  LayeredTriangulation t = coarse_triangulation(maps, 900);
  SourcePoints points = source_points(t);
  const int limit = options.max_vertices;
  const double goal = 0.5 * options.max_error;
  auto say = [&](const char* what, double e, Pass p = {}) {
    if (verbose)
      std::printf("  %s eps %.4f V %d folds %d err %.4f ch %d\n", what, e, t.vertex_count(),
                  count_folds(t), p.error, p.changes);
  };
  say("T0", 0);
  double tolerance = 0.016;
  for (int round = 0; round < 3; ++round) {
    split_long_edges(t, 0.1, limit);
    insert_boundary_points(t, tolerance, limit);
    insert_worst_points(t, points, tolerance, limit);
    split_deviating_edges(t, tolerance, limit);
    for (int k = 0; k < 3; ++k) flip_edges(t, tolerance);
  }
  say("pre", tolerance);
  for (int k = 0; k < 3; ++k) repair(t, tolerance, 15);
  say("prerep", tolerance);
  for (int sweep = 0; sweep < 30; ++sweep) {
    relax(t, {1, 0.1, -1});
    if (sweep % 3 == 2) flip_edges(t, tolerance);
    if (sweep % 10 == 9) repair(t, tolerance, 15);
  }
  say("smoothed", tolerance);
  for (int round = 0; round < 24; ++round) {
    tolerance = std::max(goal, 0.7 * tolerance);
    const double length = std::max(options.target_edge_length, 0.2 * std::pow(0.7, round));
    Pass all = split_long_edges(t, length, limit);
    all.changes += insert_boundary_points(t, tolerance, limit).changes;
    const Pass inserted = insert_worst_points(t, points, tolerance, limit);
    all.changes += inserted.changes + split_deviating_edges(t, tolerance, limit).changes;
    for (int k = 0; k < 3; ++k) flip_edges(t, tolerance);
    relax(t, {2, 0.1, round < 8 ? -1 : 0.85});
    if (round % 3 == 2) repair(t, tolerance, 15);
    say("round", tolerance, {inserted.error, all.changes});
    if ((tolerance <= goal && all.changes < 10) || t.vertex_count() >= limit) break;
  }
  for (int round = 0; round < 8; ++round) {
    for (int k = 0; k < 3; ++k) repair(t, 0.5 * goal, round < 5 ? 8 : 25);
    insert_boundary_points(t, goal, limit);
    Pass p = insert_worst_points(t, points, goal, limit);
    split_deviating_edges(t, goal, limit);
    if (round < 6) flip_edges(t, goal);
    say("repair", goal, p);
  }
  for (int k = 0; k < 2; ++k) repair(t, 0.5 * goal, 30);
  say("end", goal);
  return finish(t);
}

}  // namespace morphbake
