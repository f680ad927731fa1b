// Frames whose rotations are blended, beside the same frames without, and beside ARAP.

#include <tbb/global_control.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "bench/timing.h"
#include "morphbake/solve/solve_frames.h"
#include "morphbake/solve/state_system.h"
#include "shapes/arap.h"
#include "shapes/shapes.h"

namespace morphbake::bench {
namespace {

constexpr int kFrames = 16;
constexpr int kArapVertices = 10000;

const Observer nobody;

/// A bar, and the same bent by 120 and twisted by 270 degrees.
struct TurnedBar {
  MorphableMesh mesh;

  explicit TurnedBar(int vertices) {
    const Mesh bar = test::bar(static_cast<int>(std::sqrt(vertices / 22.0)));
    mesh = test::morphable(bar.triangles,
                           {bar.positions, test::bent_and_twisted(bar.positions, 2.1, 4.7)});
  }

  std::unique_ptr<DisplacementSystem> system() const {
    const std::vector<bool> untouched(static_cast<std::size_t>(mesh.connectivity.vertex_count));
    return std::make_unique<DisplacementSystem>(
        mesh,
        choose_constraints(mesh, connected_components(one_rings(mesh.connectivity)), untouched,
                           {HoldRule::Nothing, {}, {}, -1}),
        RightHandSide::Edge);
  }

  /// Not one mix everywhere: without turns that needs no solve.
  TransitionState state_at(double t) const {
    const Positions& bar = mesh.geometries[0];
    TransitionState T(2, bar.rows());
    for (Eigen::Index v = 0; v < bar.rows(); ++v) {
      const double share = std::clamp(t + 1e-3 * bar(v, 1), 0.0, 1.0);
      T.col(v) << 1 - share, share;
    }
    return T;
  }
};

struct Frames {
  StateSystem states;
  std::unique_ptr<SurfaceSolver> solver;

  Frames(StateSystem made, Solver kind) : states(std::move(made)) {
    SolveOptions options;
    options.solver = kind;
    options.tolerance = 1e-8;
    solver = std::make_unique<SurfaceSolver>(*states.displacements, options, nobody, states.factor);
  }

  void run(const TurnedBar& bar) const {
    std::vector<double> times;
    for (int f = 0; f < kFrames; ++f) times.push_back((f + 1.0) / (kFrames + 1));
    const auto goals_at = [&](std::span<const double> moments) {
      std::vector<TransitionState> all;
      for (const double t : moments) all.push_back(bar.state_at(t));
      return states.goals(all);
    };
    solve_frames(*solver, times, goals_at, nobody, [](int, const Positions&) {});
  }
};

StateSystem turned(const TurnedBar& bar) {
  SolveOptions options;
  options.frames = kFrames;
  return rotation_states(bar.mesh,
                         std::make_shared<SourceDeformations>(source_deformations(bar.mesh)),
                         Eigen::Vector2d(1, 0), bar.system(), options, nobody);
}

}  // namespace

void bench_rotations(int vertices, Figures& figures) {
  const tbb::global_control one_thread(tbb::global_control::max_allowed_parallelism, 1);
  const TurnedBar bar(vertices);
  const std::string group = "rotation, " + shown_count(bar.mesh.connectivity.vertex_count);
  const auto add = [&](const char* name, double value, const char* unit, const char* note) {
    figures.push_back({group + " vertices", name, value, unit, note});
  };
  const double setup = seconds_of([&] { turned(bar); });
  const Frames direct(laplacian_states(bar.mesh, Eigen::Vector2d(1, 0), bar.system()),
                      Solver::Direct);
  const Frames warm(turned(bar), Solver::Warm);
  const Pair pair = time_pair(
      3, [&] { direct.run(bar); }, [&] { warm.run(bar); });
  add("rotation, set-up", setup * 1e3, "ms", "");
  add("laplacian, direct, whole frames", pair.first / kFrames * 1e3, "ms/frame", "");
  add("rotation, warm, whole frames", pair.second / kFrames * 1e3, "ms/frame", "");
  add("rotation / laplacian", pair.ratio, "x", "pairs");
  if (vertices != 100000) return;
  const TurnedBar small(kArapVertices);
  const Frames frames(turned(small), Solver::Warm);
  const test::ArapInterpolation arap(small.mesh);
  const double relaxed = seconds_of([&] { arap.at(0.05, small.mesh.geometries[0]); });
  const double ours = median_seconds(3, [&] { frames.run(small); }) / kFrames;
  add("ARAP to convergence / rotation", relaxed / ours, "x",
      "10k vertices; one frame a twentieth of the way, once");
}

}  // namespace morphbake::bench
