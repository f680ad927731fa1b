#include "morphbake/solve/solve_frames.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <cmath>

#include "morphbake/mesh/measures.h"
#include "morphbake/solve/frame_source.h"
#include "shapes/shapes.h"

namespace morphbake {
namespace {

/// A soft plane that sweeps over a sphere and a bent copy; more frames than a chunk has.
struct Sweep {
  MorphableMesh mesh;
  std::vector<double> times;

  Sweep() {
    const Mesh sphere = test::sphere(12, 16);
    mesh =
        test::morphable(sphere.triangles, {sphere.positions, test::bent(sphere.positions, 0.3, 2)});
    for (int f = 0; f <= 90; ++f) times.push_back(f / 90.0);
  }

  Eigen::MatrixXd change_at(double time) const {
    const Positions& V = mesh.geometries[0];
    Eigen::MatrixXd change(2, V.rows());
    for (Eigen::Index v = 0; v < V.rows(); ++v) {
      const double share = std::clamp((2.9 * time - 1 - V(v, 1)) / 0.8, 0.0, 1.0);
      change.col(v) << -share, share;
    }
    return change;
  }

  DisplacementSystem system() const {
    const SeparableTimeline middle{Shares(0, 1), {{"", change_at(0.5), {}}}};
    return {mesh,
            choose_constraints(mesh, connected_components(one_rings(mesh.connectivity)),
                               untouched_vertices(middle), {HoldRule::Nothing, {}, {}, -1}),
            RightHandSide::Edge};
  }
};

struct Solved {
  std::vector<Positions> frames;
  std::vector<SolveRecord> records;
};

GoalsAt goals_of(const Sweep& sweep, const DisplacementSystem& system) {
  return [&](std::span<const double> times) {
    std::vector<Goal> goals;
    for (const double time : times) goals.push_back(system.goal(sweep.change_at(time)));
    return goals;
  };
}

Solved solve(const Sweep& sweep, const DisplacementSystem& system, Solver method) {
  SolveOptions options;
  options.solver = method;
  options.tolerance = 1e-8;
  const Observer nobody;
  const SurfaceSolver solver(system, options, nobody);
  Solved solved;
  solved.records = solve_frames(solver, sweep.times, goals_of(sweep, system), nobody,
                                [&](int frame, const Positions& positions) {
                                  EXPECT_EQ(frame, static_cast<int>(solved.frames.size()));
                                  solved.frames.push_back(positions);
                                });
  return solved;
}

class FrameSolvers : public testing::TestWithParam<Solver> {};

TEST_P(FrameSolvers, EqualSolvingEachFrameAlone) {
  const Sweep sweep;
  const DisplacementSystem system = sweep.system();
  const Solved solved = solve(sweep, system, GetParam());
  ASSERT_EQ(solved.frames.size(), sweep.times.size());
  const Observer nobody;
  const SurfaceSolver alone(system, {}, nobody);
  for (std::size_t f = 0; f < sweep.times.size(); f += 5) {
    std::vector<SolveRecord> records;
    const Positions expected = solve_change(alone, sweep.change_at(sweep.times[f]), "", records);
    EXPECT_LT(largest_distance(solved.frames[f], expected), 1e-8 * system.diagonal()) << f;
  }
  // The first frame is the start and the last is the other source: both are blends.
  EXPECT_LE(solved.records.size(), sweep.times.size() - 2);
  for (const SolveRecord& record : solved.records) {
    EXPECT_LE(record.convergence.error, 1e-8 * system.diagonal());
    EXPECT_GT(record.time, 0);
  }
  EXPECT_EQ(
      largest_distance(solved.frames.back(), sweep.mesh.geometries[1] - sweep.mesh.geometries[0]),
      0);
}

TEST_P(FrameSolvers, GiveTheSameBytesOnAnyNumberOfThreads) {
  const Sweep sweep;
  const DisplacementSystem system = sweep.system();
  const auto with_threads = [&](std::size_t count) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, count);
    return solve(sweep, system, GetParam()).frames;
  };
  EXPECT_EQ(with_threads(1), with_threads(4));
}

TEST_P(FrameSolvers, DoNotSeeFramesThatAreDoneWithBefore) {
  const Sweep sweep;
  const DisplacementSystem system = sweep.system();
  SolveOptions options;
  options.solver = GetParam();
  options.tolerance = 1e-8;
  const Observer nobody;
  const SurfaceSolver solver(system, options, nobody);
  std::vector<Goal> goals = goals_of(sweep, system)(std::vector<double>{0.4, 0.5, 0.6});
  std::vector<Eigen::MatrixXd> together;
  for (const Goal& goal : goals) together.push_back(system.start(goal));
  std::vector<Eigen::MatrixXd> near = {together[1]};
  solver.solve({goals[1]}, near);
  together[1] = near[0];  // needs fewer corrections than its neighbours
  std::vector<Eigen::MatrixXd> alone = together;
  const std::vector<Convergence> reached = solver.solve(goals, together);
  for (std::size_t i = 0; i < goals.size(); ++i) {
    std::vector<Eigen::MatrixXd> x = {alone[i]};
    const Convergence own = solver.solve({goals[i]}, x)[0];
    EXPECT_EQ(together[i], x[0]) << i;
    EXPECT_EQ(reached[i].iterations, own.iterations) << i;
    EXPECT_EQ(reached[i].residual, own.residual) << i;
    const Eigen::MatrixXd residual = system.residual(goals[i], x[0]);
    EXPECT_NEAR(own.residual * system.right_hand_side(goals[i]).norm(), residual.norm(),
                1e-12 * system.diagonal())
        << i;
  }
  if (GetParam() == Solver::Warm) {
    EXPECT_LT(reached[1].iterations, reached[0].iterations);
  }
}

std::string name_of_parameter(const testing::TestParamInfo<Solver>& info) {
  std::string name = name_of(info.param);
  std::erase(name, '-');
  return name;
}

INSTANTIATE_TEST_SUITE_P(Methods, FrameSolvers,
                         testing::Values(Solver::Direct, Solver::Warm, Solver::ConjugateGradients,
                                         Solver::GaussSeidel, Solver::Jacobi),
                         name_of_parameter);

TEST(SolvedFrames, AreKeptAndReadInAnyOrder) {
  const Sweep sweep;
  const DisplacementSystem system = sweep.system();
  const Observer nobody;
  const SurfaceSolver solver(system, {}, nobody);
  const Positions& rest = sweep.mesh.geometries[0];
  const FrameSource source =
      solved_frames(solver, rest, sweep.times, goals_of(sweep, system), nobody).source;
  const std::vector<Positions> frames = solve(sweep, system, Solver::Direct).frames;
  for (const std::size_t f : {std::size_t{90}, std::size_t{0}, std::size_t{41}}) {
    EXPECT_LT(largest_distance(source.positions(f), rest + frames[f]), 1e-9);
  }
}

}  // namespace
}  // namespace morphbake
