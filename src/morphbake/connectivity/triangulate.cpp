#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>

#include "morphbake/connectivity/refine.h"
#include "morphbake/connectivity/relax.h"
#include "morphbake/connectivity/repair.h"
#include "morphbake/connectivity/shared_triangulation.h"
#include "morphbake/correspondence/triangle_energy.h"

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
  auto dist = [&] {
    double sum = 0, all = 0;
    for (int f = 0; f < t.mesh.triangle_slots(); ++f) {
      if (!t.mesh.has_triangle(f) || t.is_cap(f)) continue;
      auto L = [&](const Layer& l) {
        auto p = [&](int k) { return l.lifted[index(t.mesh.from(3 * f + k))]; };
        return Eigen::Vector3d((p(1) - p(2)).squaredNorm(), (p(2) - p(0)).squaredNorm(),
                               (p(0) - p(1)).squaredNorm());
      };
      auto l0 = L(t.layers[0]), l1 = L(t.layers[1]);
      auto rest = rest_triangle(l0, {1e-3, 1e-14});
      double a1 = 0.5 * area_normal(t.layers[1], t.mesh.from(3 * f), t.mesh.from(3 * f + 1),
                                    t.mesh.from(3 * f + 2))
                            .norm();
      double q = 0.5 * rest.cotangents.dot(l1), r = rest.area / (a1 + 1e-300);
      sum += std::min(1e4, q * (1 + r * r) / (4 * rest.area)) * rest.area;
      all += rest.area;
    }
    return sum / all;
  };
  const auto t0 = std::chrono::steady_clock::now();
  auto say = [&](const char* what, double e, Pass p = {}) {
    if (verbose)
      std::printf("%.2f %s SD %.3f eps %.4f V %d folds %d err %.4f ch %d\n",
                  std::chrono::duration<double>(std::chrono::steady_clock::now() - t0).count(),
                  what, dist(), e, t.vertex_count(), count_folds(t), p.error, p.changes);
  };
  const double mu = std::getenv("MU") ? std::atof(std::getenv("MU")) : 0.1;
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
  repair(t, points, tolerance, 8);
  say("prerep", tolerance);
  for (int sweep = 0; sweep < 30; ++sweep) {
    relax(t, {1, 0.1, mu, -1});
    if (sweep % 3 == 2) flip_edges(t, tolerance);
    if (sweep % 10 == 9) repair(t, points, tolerance, 8);
  }
  say("smoothed", tolerance);
  const int s0 = std::getenv("S0") ? std::atoi(std::getenv("S0")) : 20;
  const int s1 = std::getenv("S1") ? std::atoi(std::getenv("S1")) : 4;
  for (int round = 0; round < 24; ++round) {
    const bool last = tolerance <= goal;
    tolerance = std::max(goal, 0.7 * tolerance);
    const double length = std::max(options.target_edge_length, 0.2 * std::pow(0.7, round));
    Pass all = split_long_edges(t, length, limit);
    all.changes += insert_boundary_points(t, tolerance, limit).changes;
    const Pass inserted = insert_worst_points(t, points, tolerance, limit);
    all.changes += inserted.changes + split_deviating_edges(t, tolerance, limit).changes;
    for (int k = 0; k < 3; ++k) flip_edges(t, tolerance);
    if (!last) {
      const int sweeps = t.vertex_count() < 3000 ? s0 : s1;
      for (int k = 0; k < sweeps; k += 2) {
        relax(t, {2, 0.1, mu, round < 8 ? -1 : 0.85});
        if (k % 6 == 0) flip_edges(t, tolerance);
      }
    }
    if (round % 3 == 2) repair(t, points, tolerance, 8);
    if (std::getenv("DBG") && round == 1) {
      for (int f = 0; f < t.mesh.triangle_slots(); ++f) {
        if (!t.mesh.has_triangle(f)) continue;
        const int a = t.mesh.from(3 * f), b = t.mesh.from(3 * f + 1), c = t.mesh.from(3 * f + 2);
        double A[2], S[2], D[2];
        for (int s = 0; s < 2; ++s) {
          auto n = area_normal(t.layers[index(s)], a, b, c);
          A[s] = n.norm();
          S[s] = n.dot(normal_below(t.layers[index(s)], a, b, c));
          auto& sp = t.layers[index(s)].sphere;
          D[s] = determinant(sp[index(a)], sp[index(b)], sp[index(c)]);
        }
        const double r = std::max(A[0] / A[1], A[1] / A[0]);
        if (r > 30)
          std::printf(
              "f %d areas %.2e %.2e seen %.2f %.2f dets %.2e %.2e fixed %d%d%d L0 %.3f %.3f %.3f "
              "L1 %.3f %.3f %.3f\n",
              f, A[0], A[1], S[0] / A[0], S[1] / A[1], D[0], D[1], t.is_fixed[index(a)],
              t.is_fixed[index(b)], t.is_fixed[index(c)],
              (t.layers[0].lifted[index(a)] - t.layers[0].lifted[index(b)]).norm(),
              (t.layers[0].lifted[index(c)] - t.layers[0].lifted[index(b)]).norm(),
              (t.layers[0].lifted[index(a)] - t.layers[0].lifted[index(c)]).norm(),
              (t.layers[1].lifted[index(a)] - t.layers[1].lifted[index(b)]).norm(),
              (t.layers[1].lifted[index(c)] - t.layers[1].lifted[index(b)]).norm(),
              (t.layers[1].lifted[index(a)] - t.layers[1].lifted[index(c)]).norm());
      }
    }
    say("round", tolerance, {inserted.error, all.changes});
    if ((last && all.changes < 10) || t.vertex_count() >= limit) break;
  }
  Repaired r = repair(t, points, goal, 5);
  say("repair", goal, {0, r.changes});
  std::printf("bad %d changes %d\n", r.bad, r.changes);
  say("end", goal);
  return finish(t);
}

}  // namespace morphbake
