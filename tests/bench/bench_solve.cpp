// Solvers on a torus and a bent copy between which a soft plane sweeps: 4 s at 30 frames a second,
// of which frames 40 to 55 are solved. One thread, as the factor's solve is.

#include <fmt/core.h>
#include <tbb/global_control.h>

#include <cmath>
#include <map>
#include <memory>
#include <numeric>

#include "bench/plain_factors.h"
#include "bench/timing.h"
#include "morphbake/linear/cholesky_factor.h"
#include "morphbake/linear/multigrid.h"
#include "morphbake/solve/solve_frames.h"
#include "shapes/shapes.h"

namespace morphbake::bench {
namespace {

constexpr int kFrames = 16;
constexpr int kRepeats = 5;
constexpr int kFramesCounted = 5;  // of which three have two neighbours
constexpr int kSweepsMeasured = 200;
constexpr int kRelaxedVertices = 20000;    // above, sweeps are extrapolated
constexpr int kIteratedVertices = 200000;  // above, steps are

struct Scene {
  MorphableMesh mesh;
  std::vector<double> times;

  explicit Scene(int vertices) {
    const int side = static_cast<int>(std::sqrt(vertices / 2.0));
    const Mesh torus = test::torus(2 * side, side);
    mesh = test::morphable(torus.triangles, {torus.positions, test::bent(torus.positions, 0.2, 1)});
    for (int f = 40; f < 40 + kFrames; ++f) times.push_back(f / 120.0);
  }

  Eigen::MatrixXd change_at(double time) const {
    const Positions& V = mesh.geometries[0];
    Eigen::MatrixXd change(2, V.rows());
    for (Eigen::Index v = 0; v < V.rows(); ++v) {
      const double u = std::clamp((3.9 * time - 1.4 - V(v, 0)) / 1.1, 0.0, 1.0);
      const double share = u * u * (3 - 2 * u);
      change.col(v) << -share, share;
    }
    return change;
  }

  std::vector<Goal> goals_at(const DisplacementSystem& system,
                             std::span<const double> moments) const {
    std::vector<Goal> goals;
    for (const double time : moments) goals.push_back(system.goal(change_at(time)));
    return goals;
  }

  DisplacementSystem system(HoldRule rule) const {
    const SeparableTimeline middle{Shares(0, 1), {{"", change_at(0.5), {}}}};
    return {mesh,
            choose_constraints(mesh, connected_components(one_rings(mesh.connectivity)),
                               untouched_vertices(middle), {rule, {}, {}, -1}),
            RightHandSide::Edge};
  }
};

SolveOptions options_of(Solver solver, double tolerance) {
  SolveOptions options;
  options.solver = solver;
  options.tolerance = tolerance;
  options.max_iterations = 10000000;
  return options;
}

const Observer nobody;

/// Iterations a frame, in order and from nothing.
struct Counts {
  double warm = 0;
  double cold = 0;
};

Counts count_iterations(const Scene& scene, const SurfaceSolver& solver) {
  Counts counts;
  const auto goals_at = [&](std::span<const double> times) {
    return scene.goals_at(solver.system(), times);
  };
  const std::vector<double> first(scene.times.begin(), scene.times.begin() + kFramesCounted);
  const std::vector<SolveRecord> records =
      solve_frames(solver, first, goals_at, nobody, [](int, const Positions&) {});
  // The first two frames have no neighbours yet.
  for (std::size_t f = 2; f < records.size(); ++f) {
    counts.warm += records[f].convergence.iterations / (kFramesCounted - 2.0);
  }
  const Goal goal = solver.system().goal(scene.change_at(scene.times[8]));
  std::vector<Eigen::MatrixXd> x = {0 * solver.system().start(goal)};
  counts.cold = solver.solve({goal}, x)[0].iterations;
  return counts;
}

double seconds_a_sweep(const DisplacementSystem& system, Solver solver, const Eigen::MatrixXd& b) {
  StopRule stop;
  stop.max_iterations = kSweepsMeasured;
  Eigen::MatrixXd x = Eigen::MatrixXd::Zero(b.rows(), 3);
  const double seconds = median_seconds(3, [&] {
    if (solver == Solver::Jacobi)
      iterate_jacobi(system.equations(), b, stop, x);
    else
      iterate_gauss_seidel(system.equations(), b, stop, x);
  });
  return seconds / kSweepsMeasured;
}

/// What relaxation costs: counted at the largest size that it is run at, then in proportion to the
/// number of vertices, as the smallest eigenvalue shrinks.
double bench_relaxation(const std::string& group, const Scene& scene,
                        const DisplacementSystem& system, Solver solver, Figures& figures) {
  const int vertices = scene.mesh.connectivity.vertex_count;
  const Goal goal = system.goal(scene.change_at(scene.times[8]));
  const Eigen::MatrixXd b = system.residual(goal, Eigen::MatrixXd::Zero(vertices, 3));
  const double sweep = seconds_a_sweep(system, solver, b);
  const bool extrapolates = vertices > kRelaxedVertices;
  // Counted at the first size, which is small enough.
  static std::map<Solver, Counts> counted;
  static double counted_vertices = 0;
  if (!extrapolates) {
    const SurfaceSolver relaxation(system, options_of(solver, 1e-6), nobody);
    counted[solver] = count_iterations(scene, relaxation);
    counted_vertices = vertices;
  }
  const Counts counts = counted.at(solver);
  const double factor = extrapolates ? vertices / counted_vertices : 1;
  const std::string note =
      extrapolates ? "extrapolated: sweeps of 10k vertices times the size, measured time a sweep"
                   : "measured";
  const double milliseconds = counts.warm * factor * sweep * 1e3;
  figures.push_back({group, name_of(solver) + ", warm, to 1e-6", milliseconds, "ms/frame", note});
  figures.push_back({group, name_of(solver) + ", warm sweeps", counts.warm * factor, "", note});
  figures.push_back({group, name_of(solver) + ", cold sweeps", counts.cold * factor, "", note});
  return milliseconds;
}

/// As bench_relaxation, but steps grow with the square root of the size.
void bench_pcg(const std::string& group, const Scene& scene, const DisplacementSystem& system,
               Figures& figures) {
  constexpr int kStepsMeasured = 50;
  const int vertices = scene.mesh.connectivity.vertex_count;
  static Counts counted;  // at the last size that is small enough
  static double counted_vertices = 0;
  const bool extrapolates = vertices > kIteratedVertices;
  if (!extrapolates) {
    const SurfaceSolver solver(system, options_of(Solver::ConjugateGradients, 1e-6), nobody);
    counted = count_iterations(scene, solver);
    counted_vertices = vertices;
  }
  const double factor = extrapolates ? std::sqrt(vertices / counted_vertices) : 1;
  const Goal goal = system.goal(scene.change_at(scene.times[8]));
  const Eigen::MatrixXd b = system.residual(goal, Eigen::MatrixXd::Zero(vertices, 3));
  const Multigrid multigrid(system.equations());
  const auto preconditioner = [&](const auto& r) { return Eigen::MatrixXd(multigrid.cycle(r)); };
  StopRule stop;
  stop.max_iterations = kStepsMeasured;
  const double step =
      median_seconds(3,
                     [&] {
                       Eigen::MatrixXd x = Eigen::MatrixXd::Zero(vertices, 3);
                       iterate_conjugate_gradients(system.equations(), preconditioner, b, stop, x);
                     }) /
      kStepsMeasured;
  const std::string note =
      extrapolates
          ? "extrapolated: steps of 100k vertices times the root of the size, measured time a step"
          : "measured";
  figures.push_back(
      {group, "pcg, warm, to 1e-6", step * counted.warm * factor * 1e3, "ms/frame", note});
  figures.push_back({group, "multigrid, bytes a vertex",
                     static_cast<double>(multigrid.bytes()) / vertices, "B", ""});
  figures.push_back({group, "pcg, warm steps", counted.warm * factor, "", note});
  figures.push_back({group, "pcg, cold steps", counted.cold * factor, "", note});
}

double sum_twice(const std::vector<double>& numbers) {
  double sum = 0;
  for (int pass = 0; pass < 2; ++pass) {
    double parts[8] = {};
    for (std::size_t i = 0; i + 8 <= numbers.size(); i += 8) {
      for (std::size_t k = 0; k < 8; ++k) parts[k] += numbers[i + k];
    }
    sum += std::accumulate(std::begin(parts), std::end(parts), 0.0);
  }
  return sum;
}

/// What others' solves take, beside ours of sixteen frames.
void bench_factor(const std::string& group, const Scene& scene, const DisplacementSystem& system,
                  double gauss_seidel, Figures& figures) {
  const int vertices = scene.mesh.connectivity.vertex_count;
  const double setup = seconds_of([&] { CholeskyFactor unused(system.equations()); });
  const CholeskyFactor factor(system.equations());
  const CholeskyFactor single(system.equations(), Precision::Single);
  Eigen::MatrixXd sixteen(vertices, 3 * kFrames);
  for (int f = 0; f < kFrames; ++f) {
    const Goal goal = system.goal(scene.change_at(scene.times[static_cast<std::size_t>(f)]));
    sixteen.middleCols(3 * f, 3) = system.residual(goal, Eigen::MatrixXd::Zero(vertices, 3));
  }
  const Eigen::SparseMatrix<double> plain_matrix = grounded(system.equations().matrix);
  const PlainCholmod cholmod(plain_matrix);
  const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> eigen(plain_matrix);
  const Eigen::MatrixXd plain_sixteen = sixteen.bottomRows(vertices - 1);
  const Eigen::MatrixXd plain_one = plain_sixteen.leftCols(3);
  const auto by_cholmod = [&](Eigen::MatrixXd b) { cholmod.solve(b); };
  const ColumnRows own_sixteen = sixteen;  // as SurfaceSolver has them
  const auto solve_own = [&](const CholeskyFactor& by) {
    ColumnRows b = own_sixteen;
    by.solve_in_place(b);
  };
  const auto ours = [&] { solve_own(factor); };
  const double a_frame = 1e3 / kFrames;
  const auto by_eigen = [&] { return Eigen::MatrixXd(eigen.solve(plain_one)); };
  const Pair eigen_pair = time_pair(
      3, [&] { by_eigen(); }, ours);
  const Pair one_pair = time_pair(
      3, [&] { by_cholmod(plain_one); }, ours);
  const Pair sixteen_pair = time_pair(
      kRepeats, [&] { by_cholmod(plain_sixteen); }, ours);
  const Pair single_pair = time_pair(
      kRepeats, [&] { by_cholmod(plain_sixteen); }, [&] { solve_own(single); });
  const std::vector<double> numbers(factor.bytes() / sizeof(double), 1.0);
  volatile double kept = 0;
  const Pair streaming = time_pair(
      kRepeats, [&] { kept = kept + sum_twice(numbers); }, ours);
  const auto add = [&](const char* name, double value, const char* unit, const char* note) {
    figures.push_back({group, name, value, unit, note});
  };
  add("factor, set-up", setup * 1e3, "ms", "");
  add("factor, bytes a vertex", static_cast<double>(factor.bytes()) / vertices, "B", "");
  add("Eigen SimplicialLDLT, one frame a solve", eigen_pair.first * 1e3, "ms/frame", "");
  add("CHOLMOD, one frame a solve", one_pair.first * 1e3, "ms/frame", "");
  add("CHOLMOD, sixteen frames a solve", sixteen_pair.first * a_frame, "ms/frame", "");
  add("float64 factor, sixteen", sixteen_pair.second * a_frame, "ms/frame", "");
  add("float32 factor, sixteen", single_pair.second * a_frame, "ms/frame", "");
  add("float64 / CHOLMOD, sixteen", sixteen_pair.ratio, "x", "pairs");
  add("float32 / CHOLMOD, sixteen", single_pair.ratio, "x", "pairs");
  add("streaming the float64 factor twice", streaming.first * 1e3, "ms", "");
  add("float64, a frame / streaming twice", streaming.ratio / kFrames, "x", "pairs");
  add("warm Gauss-Seidel / float64", gauss_seidel / (sixteen_pair.second * a_frame), "x", "");
}

/// Whole frames: goal, residuals, corrections, displacements.
void bench_frames(const std::string& group, const Scene& scene, const DisplacementSystem& system,
                  double tolerance, Figures& figures) {
  const SurfaceSolver direct(system, options_of(Solver::Direct, tolerance), nobody);
  const SurfaceSolver warm(system, options_of(Solver::Warm, tolerance), nobody);
  const auto goals_at = [&](std::span<const double> times) {
    return scene.goals_at(system, times);
  };
  int corrections = 0;
  const auto run = [&](const SurfaceSolver& solver) {
    corrections = 0;
    for (const SolveRecord& record :
         solve_frames(solver, scene.times, goals_at, nobody, [](int, const Positions&) {})) {
      corrections += record.convergence.iterations;
    }
  };
  const Pair pair = time_pair(
      3, [&] { run(direct); }, [&] { run(warm); });
  figures.push_back({group, "direct, whole frames", pair.first / kFrames * 1e3, "ms/frame", ""});
  figures.push_back({group, "warm, whole frames", pair.second / kFrames * 1e3, "ms/frame",
                     fmt::format("{} corrections for {} frames", corrections, kFrames)});
}

}  // namespace

void bench_stream(int vertices, int frames, Figures& figures) {
  Scene scene(vertices);
  scene.times.clear();
  for (int f = 0; f < frames; ++f) scene.times.push_back((f + 0.5) / frames);
  forget_peak_memory();
  const DisplacementSystem system = scene.system(HoldRule::Nothing);
  SolveOptions options = options_of(Solver::Warm, 1e-8);
  options.frames = frames;
  const double setup = seconds_of([&] { SurfaceSolver unused(system, options, nobody); });
  const SurfaceSolver solver(system, options, nobody);
  double kept = 0;
  const double seconds = seconds_of([&] {
    solve_frames(
        solver, scene.times,
        [&](std::span<const double> times) { return scene.goals_at(system, times); }, nobody,
        [&](int, const Positions& displacement) { kept += displacement(0, 0); });
  });
  const std::string group =
      fmt::format("warm, {} vertices, {} frames, all threads", shown_count(vertices), frames);
  figures.push_back({group, "set-up", setup, "s", ""});
  figures.push_back({group, "whole frames", seconds / frames * 1e3, "ms/frame",
                     kept == kept ? "none is kept" : "not a number"});
  figures.push_back({group, "peak memory a vertex", peak_memory() / vertices, "B",
                     "of the whole process, with the mesh"});
}

void bench_solvers(int vertices, Figures& figures) {
  const tbb::global_control one_thread(tbb::global_control::max_allowed_parallelism, 1);
  const Scene scene(vertices);
  const std::string size = shown_count(vertices);
  {
    const std::string group = "K_L, " + size + " vertices";
    const DisplacementSystem system = scene.system(HoldRule::Nothing);
    bench_relaxation(group, scene, system, Solver::Jacobi, figures);
    const double relaxed = bench_relaxation(group, scene, system, Solver::GaussSeidel, figures);
    bench_pcg(group, scene, system, figures);
    bench_factor(group, scene, system, relaxed, figures);
    bench_frames(group, scene, system, 1e-8, figures);
  }
  const std::string group = "held, " + size + " vertices";
  const DisplacementSystem held = scene.system(HoldRule::Untouched);
  const SurfaceSolver solver(held, options_of(Solver::Direct, 1e-8), nobody);
  figures.push_back(
      {group, "unknowns", static_cast<double>(held.equations().matrix.rows()), "", ""});
  figures.push_back({group, "factor, bytes an unknown",
                     static_cast<double>(solver.factor_bytes()) /
                         static_cast<double>(held.equations().matrix.rows()),
                     "B", ""});
  bench_frames(group, scene, held, 1e-8, figures);
}

}  // namespace morphbake::bench
