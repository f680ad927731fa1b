// Held vertices and what surrounds them: docs/method.md, "What stays".

#include <gtest/gtest.h>

#include <Eigen/Dense>

#include "morphbake/mesh/measures.h"
#include "morphbake/solve/solve_fields.h"
#include "shapes/shapes.h"

namespace morphbake {
namespace {

/// A sphere and a bent copy; a soft cap changes, the lower half does not.
struct Cap {
  MorphableMesh mesh;
  Eigen::MatrixXd change;
  SeparableTimeline timeline;

  explicit Cap(int rings = 16, int segments = 20) {
    const Mesh sphere = test::sphere(rings, segments);
    mesh =
        test::morphable(sphere.triangles, {sphere.positions, test::bent(sphere.positions, 0.3, 5)});
    change.setZero(2, sphere.positions.rows());
    for (Eigen::Index v = 0; v < change.cols(); ++v) {
      const double share = std::clamp((sphere.positions(v, 1) - 0.1) / 0.4, 0.0, 1.0);
      change.col(v) << -share, share;
    }
    timeline = {Eigen::Vector2d(1, 0),
                {{"start", Eigen::MatrixXd::Zero(2, change.cols()), {}}, {"cap", change, {0}}}};
  }

  Constraints constraints(const ConstraintRequest& request) const {
    return choose_constraints(mesh, connected_components(one_rings(mesh.connectivity)),
                              untouched_vertices(timeline), request);
  }

  Positions solve(const Constraints& constraints) const {
    const DisplacementSystem system(mesh, constraints, RightHandSide::Edge);
    const Observer nobody;
    const SurfaceSolver solver(system, {}, nobody);
    std::vector<SolveRecord> records;
    return solve_change(solver, change, "cap", records);
  }
};

TEST(Hold, UntouchedVerticesAreExactZeros) {
  const Cap cap;
  const Constraints constraints = cap.constraints({});
  const Positions moved = cap.solve(constraints);
  int held = 0;
  for (Eigen::Index v = 0; v < moved.rows(); ++v) {
    const bool is_untouched = cap.change.col(v).isZero(0);
    EXPECT_EQ(constraints.held[static_cast<std::size_t>(v)], is_untouched);
    if (!is_untouched) continue;
    ++held;
    EXPECT_TRUE(moved.row(v).isZero(0));
  }
  EXPECT_GT(held, 100);
  EXPECT_GT(moved.rowwise().norm().maxCoeff(), 0.05);
}

/// min |L u - Deg^-1 b|^2 over the free vertices, by dense QR: no normal equations.
TEST(Hold, EqualsADenseLeastSquaresSolution) {
  const Cap cap(10, 12);
  const Constraints constraints = cap.constraints({});
  const OneRings rings = one_rings(cap.mesh.connectivity);
  const int count = cap.mesh.connectivity.vertex_count;
  Eigen::MatrixXd L = Eigen::MatrixXd::Identity(count, count);
  Eigen::MatrixXd goal = Eigen::MatrixXd::Zero(count, 3);
  for (int i = 0; i < count; ++i) {
    for (int n = rings.offsets[static_cast<std::size_t>(i)];
         n < rings.offsets[static_cast<std::size_t>(i) + 1]; ++n) {
      const int j = rings.neighbours[static_cast<std::size_t>(n)];
      L(i, j) -= 1.0 / rings.degree(i);
      for (std::size_t s = 0; s < 2; ++s) {
        const auto row = static_cast<Eigen::Index>(s);
        goal.row(i) += (cap.change(row, i) + cap.change(row, j)) / 2 / rings.degree(i) *
                       (cap.mesh.geometries[s].row(i) - cap.mesh.geometries[s].row(j));
      }
    }
  }
  std::vector<int> free;
  for (int v = 0; v < count; ++v) {
    if (!constraints.held[static_cast<std::size_t>(v)]) free.push_back(v);
  }
  const Eigen::MatrixXd u = L(Eigen::all, free).colPivHouseholderQr().solve(goal);
  const Positions moved = cap.solve(constraints);
  for (std::size_t k = 0; k < free.size(); ++k) {
    EXPECT_LT((moved.row(free[k]) - u.row(static_cast<Eigen::Index>(k))).norm(), 1e-11);
  }
}

TEST(Hold, GivenVerticesStandAtTheirBlend) {
  const Cap cap;
  ConstraintRequest request{HoldRule::Given, {}, {}, -1};
  request.held.assign(static_cast<std::size_t>(cap.change.cols()), false);
  for (const std::size_t v : {std::size_t{0}, std::size_t{25}, std::size_t{300}}) {
    request.held[v] = true;
  }
  const Positions moved = cap.solve(cap.constraints(request));
  for (const Eigen::Index v : {0, 25, 300}) {
    const Eigen::RowVector3d blend = cap.change(0, v) * cap.mesh.geometries[0].row(v) +
                                     cap.change(1, v) * cap.mesh.geometries[1].row(v);
    EXPECT_EQ(moved.row(v), blend);
  }
}

TEST(Hold, NeedsFivePercentOfTheArea) {
  Cap cap;
  // All but the south pole is touched.
  for (Eigen::Index v = 0; v < cap.change.cols(); ++v) {
    if (cap.mesh.geometries[0](v, 1) > -0.99) cap.change.col(v) << -0.5, 0.5;
  }
  cap.timeline.fields[1].change = cap.change;
  const Constraints constraints = cap.constraints({});
  EXPECT_EQ(std::count(constraints.held.begin(), constraints.held.end(), true), 0);
  EXPECT_NEAR(constraints.gauge.sum(), 1, 1e-12);
}

TEST(Hold, RelaxationSaysThatItCannot) {
  const Cap cap;
  const DisplacementSystem system(cap.mesh, cap.constraints({}), RightHandSide::Edge);
  const Observer nobody;
  for (const Solver solver : {Solver::Jacobi, Solver::GaussSeidel}) {
    SolveOptions options;
    options.solver = solver;
    EXPECT_THROW(SurfaceSolver(system, options, nobody), BakeError);
  }
}

TEST(Hold, ConjugateGradientsAgreeWithTheFactor) {
  const Cap cap;
  const DisplacementSystem system(cap.mesh, cap.constraints({}), RightHandSide::Edge);
  const Observer nobody;
  SolveOptions options;
  options.solver = Solver::ConjugateGradients;
  options.tolerance = 1e-9;
  const SurfaceSolver solver(system, options, nobody);
  std::vector<SolveRecord> records;
  const Positions moved = solve_change(solver, cap.change, "cap", records);
  const double error = largest_distance(moved, cap.solve(cap.constraints({})));
  EXPECT_LT(error, options.tolerance * system.diagonal());
  ASSERT_EQ(records.size(), 1U);
  EXPECT_GT(records[0].convergence.iterations, 4);
}

}  // namespace
}  // namespace morphbake
