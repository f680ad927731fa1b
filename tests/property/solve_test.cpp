// Properties that the solve must have whatever the mesh: Alexa 2003, section 5; docs/method.md.

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>

#include "morphbake/differential/laplacian.h"
#include "morphbake/mesh/measures.h"
#include "morphbake/solve/solve_fields.h"
#include "shapes/shapes.h"

namespace morphbake {
namespace {

/// Three geometries on one connectivity with two components, one of genus 1.
MorphableMesh three_sources() {
  Mesh second = test::torus(24, 16);
  second.positions.col(0).array() += 4;
  const Mesh mesh = test::joined(test::sphere(20, 30), second);
  return test::morphable(mesh.triangles, {mesh.positions, test::bent(mesh.positions, 0.3, 1),
                                          test::bent(mesh.positions, 0.5, 2)});
}

Components components_of(const MorphableMesh& mesh) {
  return connected_components(one_rings(mesh.connectivity));
}

double diagonal_of(const MorphableMesh& mesh) { return bounding_diagonal(mesh.geometries[0]); }

ConstraintRequest hold_nothing() { return {HoldRule::Nothing, {}, {}, -1}; }

/// The change from the first source alone to shares `T`.
Eigen::MatrixXd change_to(const Eigen::MatrixXd& T) {
  Eigen::MatrixXd change = T;
  change.row(0).array() -= 1;
  return change;
}

Constraints constraints_for(const MorphableMesh& mesh, const Eigen::MatrixXd& change,
                            const ConstraintRequest& request) {
  const SeparableTimeline timeline{Shares(0, 1), {{"", change, {}}}};
  return choose_constraints(mesh, components_of(mesh), untouched_vertices(timeline), request);
}

/// The displacement of one change, all by itself.
Positions displaced(const MorphableMesh& mesh, const Eigen::MatrixXd& change,
                    const ConstraintRequest& request = hold_nothing(),
                    const SolveOptions& options = {}) {
  const DisplacementSystem system(mesh, constraints_for(mesh, change, request),
                                  options.right_hand_side);
  const Observer nobody;
  const SurfaceSolver solver(system, options, nobody);
  std::vector<SolveRecord> records;
  return solve_change(solver, change, "", records);
}

/// The solve itself, without the shortcut for components that change alike.
TEST(Solve, OneSourceAloneComesBack) {
  const MorphableMesh mesh = three_sources();
  const int count = mesh.connectivity.vertex_count;
  const OneRings rings = one_rings(mesh.connectivity);
  const Components components = components_of(mesh);
  const CholeskyFactor factor({symmetric_laplacian(rings), components.label, components.count});
  for (int s = 0; s < 3; ++s) {
    const Eigen::MatrixXd T = Eigen::VectorXd::Unit(3, s).replicate(1, count);
    const Eigen::MatrixXd solved = factor.solve(blend_edge_differences(rings, mesh.geometries, T));
    Eigen::MatrixXd difference = solved - mesh.geometries[static_cast<std::size_t>(s)];
    remove_block_means({{}, components.label, components.count}, difference);
    EXPECT_LT(difference.rowwise().norm().maxCoeff(), 1e-9 * diagonal_of(mesh));
  }
}

TEST(Solve, UniformSharesGiveTheLinearBlend) {
  const MorphableMesh mesh = three_sources();
  const Eigen::Vector3d shares(0.2, 0.5, 0.3);
  const Eigen::MatrixXd T = shares.replicate(1, mesh.connectivity.vertex_count);
  const Positions blend =
      0.2 * mesh.geometries[0] + 0.5 * mesh.geometries[1] + 0.3 * mesh.geometries[2];
  const Positions solved = mesh.geometries[0] + displaced(mesh, change_to(T));
  EXPECT_LT(largest_distance(solved, blend), 1e-15 * diagonal_of(mesh));
  // Shares that differ at one vertex by a hair take the solve; 1e-10 of the diagonal is promised.
  Eigen::MatrixXd nearly = T;
  nearly.col(0) += Eigen::Vector3d(1e-13, -1e-13, 0);
  EXPECT_LT(largest_distance(mesh.geometries[0] + displaced(mesh, change_to(nearly)), blend),
            1e-10 * diagonal_of(mesh));
}

TEST(Solve, EdgeRightHandSideSumsToZeroInEveryComponent) {
  const MorphableMesh mesh = three_sources();
  const Components components = components_of(mesh);
  const Eigen::MatrixXd weights = test::random_weights(3, mesh.connectivity.vertex_count, 7);
  const Positions b =
      blend_edge_differences(one_rings(mesh.connectivity), mesh.geometries, weights);
  Positions sums = Positions::Zero(components.count, 3);
  for (Eigen::Index v = 0; v < b.rows(); ++v) {
    sums.row(components.label[static_cast<std::size_t>(v)]) += b.row(v);
  }
  EXPECT_EQ(components.count, 2);
  EXPECT_LT(sums.cwiseAbs().maxCoeff(), 1e-12 * b.cwiseAbs().sum());
}

/// K_L and b of eq. 6 by loops over dense matrices: nothing shared with the library but the rings.
struct DenseSystem {
  Eigen::MatrixXd matrix, edge_b, vertex_b, variation;

  DenseSystem(const MorphableMesh& mesh, const Eigen::MatrixXd& change) {
    const OneRings rings = one_rings(mesh.connectivity);
    const int count = mesh.connectivity.vertex_count;
    matrix = Eigen::MatrixXd::Zero(count, count);
    edge_b = vertex_b = Eigen::MatrixXd::Zero(count, 3);
    variation = Eigen::MatrixXd::Zero(count, 1);
    for (int i = 0; i < count; ++i) {
      for (int n = rings.offsets[static_cast<std::size_t>(i)];
           n < rings.offsets[static_cast<std::size_t>(i) + 1]; ++n) {
        const int j = rings.neighbours[static_cast<std::size_t>(n)];
        matrix(i, i) += 1;
        matrix(i, j) -= 1;
        for (std::size_t s = 0; s < mesh.geometries.size(); ++s) {
          const auto row = static_cast<Eigen::Index>(s);
          const Eigen::RowVector3d edge = mesh.geometries[s].row(i) - mesh.geometries[s].row(j);
          edge_b.row(i) += (change(row, i) + change(row, j)) / 2 * edge;
          vertex_b.row(i) += change(row, i) * edge;
          variation(i) += std::abs(change(row, i) - change(row, j));
        }
      }
    }
  }
};

struct SmallScene {
  MorphableMesh mesh;
  Eigen::MatrixXd change;

  SmallScene() {
    const Mesh base = test::torus(12, 8);
    mesh = test::morphable(base.triangles, {base.positions, test::bent(base.positions, 0.4, 3)});
    change = change_to(test::random_weights(2, mesh.connectivity.vertex_count, 5));
  }

  Eigen::MatrixXd blend() const {
    Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(mesh.connectivity.vertex_count, 3);
    for (std::size_t s = 0; s < 2; ++s) {
      sum += change.row(static_cast<Eigen::Index>(s)).asDiagonal() * mesh.geometries[s];
    }
    return sum;
  }
};

/// One component: K_L + 1 g^T is regular and keeps solutions of consistent systems, with g^T x
/// known.
Eigen::MatrixXd dense_solution(const Eigen::MatrixXd& K_L, const Eigen::MatrixXd& b,
                               const Eigen::VectorXd& gauge, const Eigen::MatrixXd& blend) {
  const Eigen::VectorXd ones = Eigen::VectorXd::Ones(gauge.size());
  return (K_L + ones * gauge.transpose()).fullPivLu().solve(b + ones * (gauge.transpose() * blend));
}

TEST(Solve, EqualsADenseSolution) {
  const SmallScene scene;
  const DenseSystem dense(scene.mesh, scene.change);
  const Constraints constraints = constraints_for(scene.mesh, scene.change, hold_nothing());
  const Positions expected =
      dense_solution(dense.matrix, dense.edge_b, constraints.gauge, scene.blend());
  EXPECT_LT(largest_distance(displaced(scene.mesh, scene.change), expected),
            1e-11 * diagonal_of(scene.mesh));
}

TEST(Solve, VertexRightHandSideSpreadsItsImbalanceWhereSharesVary) {
  const SmallScene scene;
  const DenseSystem dense(scene.mesh, scene.change);
  const Eigen::RowVector3d sum = dense.vertex_b.colwise().sum();
  EXPECT_GT(sum.norm(), 0.1);
  const Eigen::MatrixXd b = dense.vertex_b - dense.variation * sum / dense.variation.sum();
  const Constraints constraints = constraints_for(scene.mesh, scene.change, hold_nothing());
  const Positions expected = dense_solution(dense.matrix, b, constraints.gauge, scene.blend());
  SolveOptions options;
  options.right_hand_side = RightHandSide::Vertex;
  EXPECT_LT(
      largest_distance(displaced(scene.mesh, scene.change, hold_nothing(), options), expected),
      1e-11 * diagonal_of(scene.mesh));
}

/// Section 4.3 of the paper, to the letter: the anchor's row becomes an identity.
TEST(Solve, AnchorDropsItsEquation) {
  const SmallScene scene;
  const DenseSystem dense(scene.mesh, scene.change);
  constexpr int kAnchor = 17;
  Eigen::MatrixXd K_L = dense.matrix, b = dense.vertex_b;
  K_L.row(kAnchor).setZero();
  K_L(kAnchor, kAnchor) = 1;
  b.row(kAnchor) = scene.blend().row(kAnchor);
  const Positions expected = K_L.fullPivLu().solve(b);
  ConstraintRequest request = hold_nothing();
  request.anchor = kAnchor;
  request.gauge_weights = Eigen::VectorXd::Unit(scene.mesh.connectivity.vertex_count, kAnchor);
  SolveOptions options;
  options.right_hand_side = RightHandSide::Vertex;
  EXPECT_LT(largest_distance(displaced(scene.mesh, scene.change, request, options), expected),
            1e-10 * diagonal_of(scene.mesh));
}

TEST(Gauge, FollowsTheWeightsThatAreGiven) {
  const SmallScene scene;
  ConstraintRequest request = hold_nothing();
  request.gauge_weights = Eigen::VectorXd::Zero(scene.mesh.connectivity.vertex_count);
  request.gauge_weights(3) = 0.5;
  request.gauge_weights(4) = 1.5;
  const Positions moved = displaced(scene.mesh, scene.change, request);
  const Eigen::MatrixXd off = moved - scene.blend();
  EXPECT_LT((0.25 * off.row(3) + 0.75 * off.row(4)).norm(), 1e-12);
  EXPECT_GT(off.row(3).norm(), 1e-3);
}

/// One component morphs locally, the other not at all: it must not move.
TEST(Solve, ComponentsDoNotDrift) {
  const MorphableMesh mesh = three_sources();
  const Components components = components_of(mesh);
  Eigen::MatrixXd change = Eigen::MatrixXd::Zero(3, mesh.connectivity.vertex_count);
  for (Eigen::Index v = 0; v < 40; ++v) change.col(v) << -1, 1, 0;
  const Positions moved = displaced(mesh, change);
  const int morphing = components.label[0];
  for (Eigen::Index v = 0; v < moved.rows(); ++v) {
    if (components.label[static_cast<std::size_t>(v)] != morphing) {
      EXPECT_EQ(moved.row(v).norm(), 0);
    }
  }
  EXPECT_GT(moved.rowwise().norm().maxCoeff(), 0.01);
  // The untouched part of the component stays in the mean.
  const Constraints constraints = constraints_for(mesh, change, hold_nothing());
  const Eigen::RowVector3d drift = constraints.gauge.transpose() * moved;
  EXPECT_LT(drift.norm(), 1e-12 * diagonal_of(mesh));
}

TEST(Solve, TranslatingASourceMovesNothingButTheGauge) {
  const MorphableMesh mesh = three_sources();
  MorphableMesh shifted = mesh;
  shifted.geometries[1].rowwise() += Eigen::RowVector3d(10, -3, 2);
  const Components components = components_of(mesh);
  const Eigen::MatrixXd change =
      change_to(test::random_weights(3, mesh.connectivity.vertex_count, 11));
  const Positions difference = displaced(shifted, change) - displaced(mesh, change);
  for (int component = 0; component < 2; ++component) {
    Eigen::RowVector3d first = Eigen::RowVector3d::Constant(NAN);
    for (Eigen::Index v = 0; v < difference.rows(); ++v) {
      if (components.label[static_cast<std::size_t>(v)] != component) continue;
      if (first.hasNaN()) first = difference.row(v);
      EXPECT_LT((difference.row(v) - first).norm(), 1e-10 * diagonal_of(mesh));
    }
  }
}

TEST(Solve, CommutesWithRenumbering) {
  const MorphableMesh mesh = three_sources();
  const int count = mesh.connectivity.vertex_count;
  std::vector<int> to(static_cast<std::size_t>(count));
  std::iota(to.begin(), to.end(), 0);
  std::shuffle(to.begin(), to.end(), std::mt19937(4));
  MorphableMesh renumbered = mesh;
  for (int& vertex : renumbered.connectivity.triangles.reshaped())
    vertex = to[static_cast<std::size_t>(vertex)];
  // Part of both components is untouched: with `hold` it stays.
  Eigen::MatrixXd change = change_to(test::random_weights(3, count, 13));
  for (int v = 0; v < count; v += 3) change.col(v).setZero();
  Eigen::MatrixXd renumbered_change = change;
  for (int v = 0; v < count; ++v) {
    const int target = to[static_cast<std::size_t>(v)];
    renumbered_change.col(target) = change.col(v);
    for (std::size_t s = 0; s < 3; ++s)
      renumbered.geometries[s].row(target) = mesh.geometries[s].row(v);
  }
  for (const HoldRule rule : {HoldRule::Nothing, HoldRule::Untouched}) {
    const Positions a = displaced(mesh, change, {rule, {}, {}, -1});
    const Positions b = displaced(renumbered, renumbered_change, {rule, {}, {}, -1});
    for (int v = 0; v < count; ++v) {
      EXPECT_LT((a.row(v) - b.row(to[static_cast<std::size_t>(v)])).norm(),
                1e-10 * diagonal_of(mesh));
    }
  }
}

}  // namespace
}  // namespace morphbake
