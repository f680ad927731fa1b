#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <functional>
#include <memory>
#include <numbers>

#include "morphbake/mesh/measures.h"
#include "morphbake/solve/affine_blend.h"
#include "morphbake/solve/solve_fields.h"
#include "morphbake/solve/state_system.h"
#include "shapes/shapes.h"

namespace morphbake {
namespace {

constexpr double kDegree = std::numbers::pi / 180;

/// Root mean square of what edges are longer or shorter than the mean of both ends', relative.
double edge_error(const MorphableMesh& mesh, const Positions& positions, double share) {
  double sum = 0;
  const Triangles& triangles = mesh.connectivity.triangles;
  for (const auto& f : triangles.rowwise()) {
    for (int k = 0; k < 3; ++k) {
      const int a = f(k), b = f((k + 1) % 3);
      const auto length = [&](const Positions& of) { return (of.row(a) - of.row(b)).norm(); };
      const double expected =
          (1 - share) * length(mesh.geometries[0]) + share * length(mesh.geometries[1]);
      sum += std::pow(length(positions) / expected - 1, 2);
    }
  }
  return std::sqrt(sum / static_cast<double>(triangles.size()));
}

struct Rule {
  HoldRule hold = HoldRule::Nothing;
  std::vector<bool> held = {};
  Shares reference = Shares(0, 0);  ///< none: the first source
  SolveOptions options = {};
};

/// A mesh with its system, ready to give the shape of any transition state.
class Shapes {
 public:
  explicit Shapes(const MorphableMesh& mesh, const Rule& rule = {})
      : mesh_(mesh),
        deformations_(std::make_shared<SourceDeformations>(source_deformations(mesh))) {
    const auto sources = static_cast<Eigen::Index>(mesh.geometries.size());
    Shares reference = rule.reference;
    if (reference.rows() == 0) reference = Eigen::VectorXd::Unit(sources, 0);
    const Components components = connected_components(one_rings(mesh.connectivity));
    const std::vector<bool> untouched(static_cast<std::size_t>(mesh.connectivity.vertex_count));
    auto displacements = std::make_unique<DisplacementSystem>(
        mesh, choose_constraints(mesh, components, untouched, {rule.hold, rule.held, {}, -1}),
        RightHandSide::Edge);
    states_ = std::make_unique<StateSystem>(rotation_states(
        mesh, deformations_, reference, std::move(displacements), rule.options, nobody_));
    solver_ = std::make_unique<SurfaceSolver>(*states_->displacements, rule.options, nobody_,
                                              states_->factor);
  }

  const StateSystem& states() const { return *states_; }

  const SourceDeformations& deformations() const { return *deformations_; }

  Positions of(const TransitionState& T) const {
    std::vector<SolveRecord> records;
    return states_->rest + solve_goal(*solver_, states_->goal(T), "", records);
  }

  /// Of shares that are the same everywhere.
  Positions of_mix(const Eigen::VectorXd& shares) const {
    return of(uniform_transition(shares, mesh_.connectivity.vertex_count));
  }

 private:
  const MorphableMesh& mesh_;
  std::shared_ptr<const SourceDeformations> deformations_;
  Observer nobody_;
  std::unique_ptr<StateSystem> states_;
  std::unique_ptr<SurfaceSolver> solver_;
};

MorphableMesh bars(double bend, double twist) {
  const Mesh bar = test::bar(20);
  return test::morphable(
      bar.triangles,
      {bar.positions, test::bent_and_twisted(bar.positions, bend * kDegree, twist * kDegree)});
}

struct Bar {
  double twist = 0;
  double volume_error = 0;
  double edge_error = 0;
};

class Bars : public testing::TestWithParam<Bar> {};

TEST_P(Bars, KeepVolumeAndLengthsHalfWay) {
  const MorphableMesh mesh = bars(120, GetParam().twist);
  const Shapes shapes(mesh);
  const Positions half = shapes.of_mix(Eigen::Vector2d(0.5, 0.5));
  const Triangles& triangles = mesh.connectivity.triangles;
  const double expected = (enclosed_volume(mesh.geometries[0], triangles) +
                           enclosed_volume(mesh.geometries[1], triangles)) /
                          2;
  EXPECT_NEAR(enclosed_volume(half, triangles) / expected, 1, GetParam().volume_error);
  EXPECT_LT(edge_error(mesh, half, 0.5), GetParam().edge_error);
}

INSTANTIATE_TEST_SUITE_P(Rotation, Bars,
                         testing::Values(Bar{0, 0.001, 0.001}, Bar{270, 0.02, 0.015},
                                         Bar{540, 0.08, 0.04}));

TEST(Rotation, EndsAreTheSources) {
  const MorphableMesh mesh = bars(120, 540);
  const Shapes shapes(mesh);
  EXPECT_EQ(shapes.of_mix(Eigen::Vector2d(1, 0)), mesh.geometries[0]);
  EXPECT_LT(largest_distance(shapes.of_mix(Eigen::Vector2d(0, 1)), mesh.geometries[1]), 1e-12);
  // Also where they are solved for, since the shares are not quite those of a source.
  const double diagonal = bounding_diagonal(mesh.geometries[0]);
  const double nearly = 1 - 1e-13;
  EXPECT_LT(
      largest_distance(shapes.of_mix(Eigen::Vector2d(1 - nearly, nearly)), mesh.geometries[1]),
      1e-9 * diagonal);
  EXPECT_LT(
      largest_distance(shapes.of_mix(Eigen::Vector2d(nearly, 1 - nearly)), mesh.geometries[0]),
      1e-9 * diagonal);
}

TEST(Rotation, EveryVertexIsAtRestBetweenItsNeighbours) {
  // The normal equations of the least squares, with logarithms that are computed here.
  const MorphableMesh mesh = bars(120, 270);
  const Shapes shapes(mesh);
  const Observer nobody;
  const RotationBlend blend(mesh, std::make_shared<SourceDeformations>(shapes.deformations()),
                            *shapes.states().displacements, Eigen::Vector2d(1, 0), {}, nobody);
  TransitionState T(2, mesh.connectivity.vertex_count);
  for (Eigen::Index v = 0; v < T.cols(); ++v) {
    const double share = std::clamp(mesh.geometries[0](v, 1) + 0.2, 0.0, 1.0);
    T.col(v) << 1 - share, share;
  }
  const RotationField R = blend.rotations({&T, 1}).front();
  const Deformation& bent = shapes.deformations().against_first[0];
  const std::vector<Edge>& edges = shapes.deformations().edges;
  Positions sums = Positions::Zero(T.cols(), 3);
  for (std::size_t e = 0; e < edges.size(); ++e) {
    const Edge& edge = edges[e];
    const auto a = static_cast<std::size_t>(edge.a), b = static_cast<std::size_t>(edge.b);
    const Eigen::Matrix3d between =
        bent.rotations[a].toRotationMatrix().transpose() * bent.rotations[b].toRotationMatrix();
    const Eigen::AngleAxisd turn(between);
    const double share = (T(1, edge.a) + T(1, edge.b)) / 2;
    const Eigen::Matrix3d misfit =
        R[a].toRotationMatrix() *
        Eigen::AngleAxisd(share * turn.angle(), turn.axis()).toRotationMatrix() *
        R[b].toRotationMatrix().transpose();
    const Eigen::AngleAxisd rest(misfit);
    sums.row(edge.a) += (rest.angle() * rest.axis()).transpose();
    sums.row(edge.b) -= (rest.angle() * rest.axis()).transpose();
  }
  EXPECT_LT(sums.rowwise().norm().maxCoeff(), 1e-5);
}

TEST(Rotation, CanBeInterrupted) {
  const MorphableMesh mesh = bars(120, 270);
  bool stops = false;
  Observer observer;
  observer.is_cancelled = [&stops] { return stops; };
  const Shapes shapes(mesh);
  const RotationBlend blend(mesh, std::make_shared<SourceDeformations>(shapes.deformations()),
                            *shapes.states().displacements, Eigen::Vector2d(1, 0), {}, observer);
  const TransitionState half =
      uniform_transition(Eigen::Vector2d(0.5, 0.5), mesh.connectivity.vertex_count);
  EXPECT_EQ(blend.shapes({&half, 1}).size(), 1U);
  stops = true;
  EXPECT_THROW(blend.shapes({&half, 1}), Cancelled);
}

TEST(Rotation, ATurnedSourceChangesTheRigidPathAlone) {
  const MorphableMesh mesh = bars(90, 200);
  const Eigen::Matrix3d turn =
      Eigen::AngleAxisd(2.5, Eigen::Vector3d(1, 2, -1).normalized()).toRotationMatrix();
  MorphableMesh turned = mesh;
  turned.geometries[1] = mesh.geometries[1] * turn.transpose();
  const Positions plain = Shapes(mesh).of_mix(Eigen::Vector2d(0.6, 0.4));
  const Positions moved = Shapes(turned).of_mix(Eigen::Vector2d(0.6, 0.4));
  const Eigen::Matrix4d rigid = Eigen::umeyama(Eigen::Matrix3Xd(moved.transpose()),
                                               Eigen::Matrix3Xd(plain.transpose()), false);
  const Positions back = (moved * rigid.topLeftCorner<3, 3>().transpose()).rowwise() +
                         rigid.col(3).head<3>().transpose();
  EXPECT_LT(largest_distance(back, plain), 1e-9);
  EXPECT_GT(largest_distance(moved, plain), 0.1);
}

TEST(Rotation, WithoutAFactorTheSame) {
  const MorphableMesh mesh = bars(120, 270);
  Rule little;
  little.options.memory_limit = 0;
  const Eigen::Vector2d half(0.5, 0.5);
  EXPECT_LT(largest_distance(Shapes(mesh, little).of_mix(half), Shapes(mesh).of_mix(half)), 1e-6);
}

TEST(Rotation, OfThreeSources) {
  const Mesh bar = test::bar(12);
  const auto bent = [&](double bend, double twist) {
    return test::bent_and_twisted(bar.positions, bend * kDegree, twist * kDegree);
  };
  const MorphableMesh mesh =
      test::morphable(bar.triangles, {bent(40, 0), bent(0, 200), bent(120, -90)});
  const Shapes shapes(mesh);
  const double whole = enclosed_volume(bar.positions, bar.triangles);
  const Positions mixed = shapes.of_mix(Eigen::Vector3d(0.3, 0.4, 0.3));
  EXPECT_NEAR(enclosed_volume(mixed, bar.triangles) / whole, 1, 0.02);
  EXPECT_EQ(shapes.of_mix(Eigen::Vector3d(0, 1, 0)),
            shapes.states().rest + (mesh.geometries[1] - shapes.states().rest));
}

TEST(Rotation, WhatIsHeldStaysAndTheRestBends) {
  const MorphableMesh mesh = bars(120, 90);
  const Eigen::Index count = mesh.connectivity.vertex_count;
  Rule rule{HoldRule::Given, std::vector<bool>(static_cast<std::size_t>(count)), {}};
  Eigen::MatrixXd T(2, count);
  for (Eigen::Index v = 0; v < count; ++v) {
    const double along = mesh.geometries[0](v, 1);
    rule.held[static_cast<std::size_t>(v)] = along < 0.25;
    const double share = std::clamp((along - 0.25) / 0.2, 0.0, 1.0);
    T.col(v) << 1 - share, share;
  }
  const Shapes shapes(mesh, rule);
  const Positions shape = shapes.of(T);
  for (Eigen::Index v = 0; v < count; ++v) {
    if (!rule.held[static_cast<std::size_t>(v)]) continue;
    EXPECT_EQ(shape.row(v), mesh.geometries[0].row(v));
  }
  const Triangles& triangles = mesh.connectivity.triangles;
  EXPECT_NEAR(enclosed_volume(shape, triangles) / enclosed_volume(mesh.geometries[0], triangles), 1,
              0.03);
  // The free end looks where it would look, were it bent from there on.
  const Positions& start = mesh.geometries[0];
  Eigen::Index top = 0, below = 0;
  (start.col(1) - start.col(0).cwiseAbs()).maxCoeff(&top);
  (start.col(1) - start.col(0).cwiseAbs()).minCoeff(&below);
  EXPECT_GT((shape.row(top) - start.row(top)).norm(), 0.2);
}

TEST(Rotation, HeldPartsOfAMixStandAsTheMixDoes) {
  const MorphableMesh mesh = bars(120, 180);
  const Eigen::Index count = mesh.connectivity.vertex_count;
  Rule rule{HoldRule::Given, std::vector<bool>(static_cast<std::size_t>(count)),
            Eigen::Vector2d(0.5, 0.5)};
  for (Eigen::Index v = 0; v < count; ++v) {
    rule.held[static_cast<std::size_t>(v)] = mesh.geometries[0](v, 1) < 0.25;
  }
  const Shapes held(mesh, rule);
  const Positions free = Shapes(mesh).of_mix(Eigen::Vector2d(0.5, 0.5));
  const Positions mix = held.of_mix(Eigen::Vector2d(0.5, 0.5));
  EXPECT_LT(largest_distance(mix, held.states().rest), 1e-7);
  EXPECT_LT(largest_distance(mix, free), 5e-3);  // whose rotations were fitted
}

/// Half-way between a torus and a copy that is turned by 150 degrees and moved.
Positions half_of_turned_torus(
    const std::function<StateSystem(const MorphableMesh&, std::unique_ptr<DisplacementSystem>)>&
        make) {
  const Mesh torus = test::torus(24, 16);
  const Eigen::Matrix3d turn =
      Eigen::AngleAxisd(150 * kDegree, Eigen::Vector3d(1, 1, 0).normalized()).toRotationMatrix();
  Positions turned = torus.positions * turn.transpose();
  turned.rowwise() += Eigen::RowVector3d(3, 0, 1);
  const MorphableMesh mesh = test::morphable(torus.triangles, {torus.positions, turned});
  const Components components = connected_components(one_rings(mesh.connectivity));
  const std::vector<bool> untouched(static_cast<std::size_t>(mesh.connectivity.vertex_count));
  auto system = std::make_unique<DisplacementSystem>(
      mesh, choose_constraints(mesh, components, untouched, {HoldRule::Nothing, {}, {}, -1}),
      RightHandSide::Edge);
  const StateSystem states = make(mesh, std::move(system));
  const Goal goal =
      states.goal(uniform_transition(Eigen::Vector2d(0.5, 0.5), mesh.connectivity.vertex_count));
  EXPECT_TRUE(goal.is_blend());
  return states.rest + goal.blend;
}

TEST(Rigid, MovesATurnedCopyAsAWhole) {
  const Positions half = half_of_turned_torus([](const auto& mesh, auto system) {
    return rigid_states(mesh, Eigen::Vector2d(1, 0), std::move(system));
  });
  const Mesh torus = test::torus(24, 16);
  const Eigen::Matrix3d turn =
      Eigen::AngleAxisd(75 * kDegree, Eigen::Vector3d(1, 1, 0).normalized()).toRotationMatrix();
  const Positions expected =
      (torus.positions * turn.transpose()).rowwise() + Eigen::RowVector3d(1.5, 0, 0.5);
  EXPECT_LT(largest_distance(half, expected), 1e-9);
}

TEST(Absolute, ShrinksATurnedCopy) {
  const Positions half = half_of_turned_torus([](const auto& mesh, auto system) {
    return absolute_states(mesh, Eigen::Vector2d(1, 0), std::move(system));
  });
  EXPECT_LT(bounding_diagonal(half), 0.8 * bounding_diagonal(test::torus(24, 16).positions));
}

TEST(Affine, GivesBackItsSourcesAndWhatLiesBetween) {
  const MorphableMesh mesh = bars(60, 30);
  const Components components = connected_components(one_rings(mesh.connectivity));
  const std::vector<bool> untouched(static_cast<std::size_t>(mesh.connectivity.vertex_count));
  const Constraints constraints =
      choose_constraints(mesh, components, untouched, {HoldRule::Nothing, {}, {}, -1});
  const AffineBlend blend(mesh, constraints, mesh.geometries[0]);
  const double diagonal = bounding_diagonal(mesh.geometries[0]);
  for (int source = 0; source < 2; ++source) {
    const Eigen::VectorXd shares = Eigen::Vector2d::Unit(source);
    // From far away: from the source itself nothing would be left to do.
    Positions elsewhere = mesh.geometries[static_cast<std::size_t>(source)];
    for (auto row : elsewhere.rowwise()) row.x() += 0.05 * std::sin(20 * row.y());
    const Positions shape =
        blend.shape(uniform_transition(shares, mesh.connectivity.vertex_count), elsewhere);
    const Positions& expected = mesh.geometries[static_cast<std::size_t>(source)];
    const Positions away = shape - expected;
    EXPECT_LT((away.rowwise() - away.colwise().mean()).rowwise().norm().maxCoeff(),
              1e-8 * diagonal);
  }
}

}  // namespace
}  // namespace morphbake
