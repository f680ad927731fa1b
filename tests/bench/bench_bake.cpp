// What a bake spends its time on, by mesh size. The argument is the number of vertices.

#include <benchmark/benchmark.h>

#include <cmath>
#include <map>

#include "morphbake/solve/solve_fields.h"
#include "morphbake/transition/surface_distance.h"
#include "shapes/shapes.h"

namespace morphbake {
namespace {

/// A torus of about `vertices` vertices and a bent copy, made once a size.
const MorphableMesh& sources_of(std::int64_t vertices) {
  static std::map<std::int64_t, MorphableMesh> made;
  const auto [entry, is_new] = made.try_emplace(vertices);
  if (is_new) {
    const auto side = static_cast<int>(std::sqrt(static_cast<double>(vertices) / 2));
    const Mesh mesh = test::torus(2 * side, side);
    entry->second =
        test::morphable(mesh.triangles, {mesh.positions, test::bent(mesh.positions, 0.2, 1)});
  }
  return entry->second;
}

Mesh mesh_of(const MorphableMesh& mesh) {
  return {mesh.geometries[0], mesh.connectivity.triangles};
}

void Factorise(benchmark::State& state) {
  const MorphableMesh& mesh = sources_of(state.range(0));
  for (auto _ : state) benchmark::DoNotOptimize(LaplacianSystem(mesh));
}

void SolveOneField(benchmark::State& state) {
  const MorphableMesh& mesh = sources_of(state.range(0));
  const LaplacianSystem system(mesh);
  const Eigen::MatrixXd weights = test::random_weights(2, mesh.connectivity.vertex_count, 3);
  const TranslationGauge gauge = choose_gauge(mesh, system.components(), {{"start", weights, {}}});
  for (auto _ : state) benchmark::DoNotOptimize(system.solve(weights, gauge));
}

void BallByEdges(benchmark::State& state) {
  const Mesh mesh = mesh_of(sources_of(state.range(0)));
  for (auto _ : state) benchmark::DoNotOptimize(edge_distances(mesh, {0, {1, 0, 0}}));
}

void BallByGeodesics(benchmark::State& state) {
  const Mesh mesh = mesh_of(sources_of(state.range(0)));
  for (auto _ : state) benchmark::DoNotOptimize(geodesic_distances(mesh, {{0, {0.3, 0.3, 0.4}}}));
}

BENCHMARK(Factorise)->Arg(10000)->Arg(100000)->Arg(500000)->Unit(benchmark::kMillisecond);
BENCHMARK(SolveOneField)->Arg(10000)->Arg(100000)->Arg(500000)->Unit(benchmark::kMillisecond);
BENCHMARK(BallByEdges)->Arg(10000)->Arg(100000)->Arg(500000)->Unit(benchmark::kMillisecond);
BENCHMARK(BallByGeodesics)->Arg(10000)->Arg(100000)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace morphbake
