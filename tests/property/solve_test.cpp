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

TransitionField uniform_field(const Eigen::VectorXd& shares, int vertices) {
  return {"start", shares.replicate(1, vertices), {}};
}

double diagonal_of(const MorphableMesh& mesh) { return bounding_diagonal(mesh.geometries[0]); }

TEST(Solve, OneSourceAloneComesBack) {
  const MorphableMesh mesh = three_sources();
  const LaplacianSystem system(mesh);
  for (int s = 0; s < 3; ++s) {
    const TransitionField field =
        uniform_field(Eigen::VectorXd::Unit(3, s), mesh.connectivity.vertex_count);
    const TranslationGauge gauge = choose_gauge(mesh, system.components(), {field});
    const Positions solved = system.solve(field.weights, gauge);
    EXPECT_LT(largest_distance(solved, mesh.geometries[static_cast<std::size_t>(s)]),
              1e-9 * diagonal_of(mesh));
  }
}

TEST(Solve, UniformSharesGiveTheLinearBlend) {
  const MorphableMesh mesh = three_sources();
  const LaplacianSystem system(mesh);
  const Eigen::Vector3d shares(0.2, 0.5, 0.3);
  const TransitionField field = uniform_field(shares, mesh.connectivity.vertex_count);
  const TranslationGauge gauge = choose_gauge(mesh, system.components(), {field});
  const Positions blend =
      0.2 * mesh.geometries[0] + 0.5 * mesh.geometries[1] + 0.3 * mesh.geometries[2];
  EXPECT_LT(largest_distance(system.solve(field.weights, gauge), blend), 1e-10 * diagonal_of(mesh));
  EXPECT_LT(largest_distance(system.solve_or_blend(field.weights, gauge), blend),
            1e-15 * diagonal_of(mesh));
}

TEST(Solve, RightHandSideSumsToZeroInEveryComponent) {
  const MorphableMesh mesh = three_sources();
  const LaplacianSystem system(mesh);
  const Eigen::MatrixXd weights = test::random_weights(3, mesh.connectivity.vertex_count, 7);
  const Positions b =
      blend_edge_differences(one_rings(mesh.connectivity), mesh.geometries, weights);
  Positions sums = Positions::Zero(system.components().count, 3);
  for (Eigen::Index v = 0; v < b.rows(); ++v) {
    sums.row(system.components().label[static_cast<std::size_t>(v)]) += b.row(v);
  }
  EXPECT_EQ(system.components().count, 2);
  EXPECT_LT(sums.cwiseAbs().maxCoeff(), 1e-12 * b.cwiseAbs().sum());
}

/// The same system by dense Eigen: nothing shared with CHOLMOD or with the grounding.
Positions dense_solution(const MorphableMesh& mesh, const Eigen::MatrixXd& weights,
                         const TranslationGauge& gauge) {
  const OneRings rings = one_rings(mesh.connectivity);
  const int count = mesh.connectivity.vertex_count;
  Eigen::MatrixXd K_L = Eigen::MatrixXd::Zero(count, count);
  Eigen::MatrixXd b = Eigen::MatrixXd::Zero(count, 3);
  for (int i = 0; i < count; ++i) {
    for (int n = rings.offsets[static_cast<std::size_t>(i)];
         n < rings.offsets[static_cast<std::size_t>(i) + 1]; ++n) {
      const int j = rings.neighbours[static_cast<std::size_t>(n)];
      K_L(i, i) += 1;
      K_L(i, j) -= 1;
      for (std::size_t s = 0; s < mesh.geometries.size(); ++s) {
        const auto row = static_cast<Eigen::Index>(s);
        b.row(i) += (weights(row, i) + weights(row, j)) / 2 *
                    (mesh.geometries[s].row(i) - mesh.geometries[s].row(j));
      }
    }
  }
  Eigen::MatrixXd centroid = Eigen::MatrixXd::Zero(1, 3);
  for (std::size_t s = 0; s < mesh.geometries.size(); ++s) {
    centroid +=
        (gauge.weights.array() * weights.row(static_cast<Eigen::Index>(s)).transpose().array())
            .matrix()
            .transpose() *
        mesh.geometries[s];
  }
  // One component: K_L + 1 g^T is regular and keeps solutions of consistent systems, with g^T x
  // known.
  const Eigen::MatrixXd regular = K_L + Eigen::VectorXd::Ones(count) * gauge.weights.transpose();
  return regular.fullPivLu().solve(b + Eigen::VectorXd::Ones(count) * centroid);
}

TEST(Solve, EqualsADenseSolution) {
  const Mesh base = test::torus(12, 8);
  const MorphableMesh mesh =
      test::morphable(base.triangles, {base.positions, test::bent(base.positions, 0.4, 3)});
  const LaplacianSystem system(mesh);
  const Eigen::MatrixXd weights = test::random_weights(2, mesh.connectivity.vertex_count, 5);
  const TranslationGauge gauge = choose_gauge(mesh, system.components(), {{"start", weights, {}}});
  EXPECT_LT(largest_distance(system.solve(weights, gauge), dense_solution(mesh, weights, gauge)),
            1e-11 * diagonal_of(mesh));
}

/// One component morphs locally, the other not at all: it must not move.
TEST(Solve, ComponentsDoNotDrift) {
  const MorphableMesh mesh = three_sources();
  const LaplacianSystem system(mesh);
  Eigen::MatrixXd start = Eigen::Vector3d(1, 0, 0).replicate(1, mesh.connectivity.vertex_count);
  Eigen::MatrixXd change = Eigen::MatrixXd::Zero(3, mesh.connectivity.vertex_count);
  for (Eigen::Index v = 0; v < 40; ++v) change.col(v) << -1, 1, 0;
  const std::vector<TransitionField> fields = {{"start", start, {}}, {"local", change, {0}}};
  const TranslationGauge gauge = choose_gauge(mesh, system.components(), fields);
  const Positions moved = system.solve_or_blend(change, gauge);
  const int morphing = system.components().label[0];
  for (Eigen::Index v = 0; v < moved.rows(); ++v) {
    if (system.components().label[static_cast<std::size_t>(v)] != morphing) {
      EXPECT_EQ(moved.row(v).norm(), 0);
    }
  }
  EXPECT_GT(moved.rowwise().norm().maxCoeff(), 0.01);
  // The untouched part of the component stays in the mean.
  const Eigen::RowVector3d drift = gauge.weights.transpose() * moved;
  EXPECT_LT(drift.norm(), 1e-12 * diagonal_of(mesh));
}

TEST(Solve, TranslatingASourceMovesNothingButTheGauge) {
  const MorphableMesh mesh = three_sources();
  MorphableMesh shifted = mesh;
  shifted.geometries[1].rowwise() += Eigen::RowVector3d(10, -3, 2);
  const Eigen::MatrixXd weights = test::random_weights(3, mesh.connectivity.vertex_count, 11);
  const LaplacianSystem system(mesh), shifted_system(shifted);
  const TranslationGauge gauge = choose_gauge(mesh, system.components(), {{"start", weights, {}}});
  const Positions a = system.solve(weights, gauge);
  const Positions b = shifted_system.solve(weights, gauge);
  const Positions difference = b - a;
  for (int component = 0; component < 2; ++component) {
    Eigen::RowVector3d first = Eigen::RowVector3d::Constant(NAN);
    for (Eigen::Index v = 0; v < difference.rows(); ++v) {
      if (system.components().label[static_cast<std::size_t>(v)] != component) continue;
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
  const Eigen::MatrixXd weights = test::random_weights(3, count, 13);
  Eigen::MatrixXd renumbered_weights = weights;
  for (int v = 0; v < count; ++v) {
    const int target = to[static_cast<std::size_t>(v)];
    renumbered_weights.col(target) = weights.col(v);
    for (std::size_t s = 0; s < 3; ++s)
      renumbered.geometries[s].row(target) = mesh.geometries[s].row(v);
  }
  const LaplacianSystem system(mesh), renumbered_system(renumbered);
  const Positions a =
      system.solve(weights, choose_gauge(mesh, system.components(), {{"start", weights, {}}}));
  const Positions b = renumbered_system.solve(
      renumbered_weights, choose_gauge(renumbered, renumbered_system.components(),
                                       {{"start", renumbered_weights, {}}}));
  for (int v = 0; v < count; ++v) {
    EXPECT_LT((a.row(v) - b.row(to[static_cast<std::size_t>(v)])).norm(),
              1e-10 * diagonal_of(mesh));
  }
}

}  // namespace
}  // namespace morphbake
