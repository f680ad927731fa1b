#include "morphbake/preview/motion_measures.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "morphbake/diagnostics/problem.h"
#include "shapes/sources.h"

namespace morphbake {
namespace {

using Weights = std::vector<float>;

/// `mesh` with one target, `moved` less its positions; keys at 0, 1, 2 ... seconds.
AnimatedMesh animated(const Mesh& mesh, const Positions& moved, const Weights& weights) {
  AnimatedMesh result;
  AnimatedPrimitive& primitive = result.primitives.emplace_back();
  primitive.triangles = mesh.triangles;
  primitive.positions = mesh.positions.cast<float>();
  primitive.target_positions = {(moved - mesh.positions).cast<float>()};
  result.target_names = {"moved"};
  result.weights.values.resize(static_cast<Eigen::Index>(weights.size()), 1);
  for (std::size_t i = 0; i < weights.size(); ++i) {
    result.weights.times.push_back(static_cast<float>(i));
    result.weights.values(static_cast<Eigen::Index>(i), 0) = weights[i];
  }
  return result;
}

MotionMeasures measured(const Mesh& mesh, const AnimatedMesh& motion,
                        const std::vector<double>& times, int threads = 0) {
  return measure_motion(motion, follow_surface(test::source_of(mesh, "a")), times, threads, {});
}

/// Two triangles over the edge from the origin to (0, 1, 0), flat.
Mesh hinge() {
  Mesh mesh{Positions(4, 3), Triangles(2, 3)};
  mesh.positions << 0, 0, 0, 0, 1, 0, -1, 0, 0, 1, 0, 0;
  mesh.triangles << 0, 1, 2, 1, 0, 3;
  return mesh;
}

TEST(MotionMeasures, RefuseNumbersThatAreNotFinite) {
  Mesh mesh = test::tetrahedron();
  AnimatedMesh motion = animated(mesh, 2 * mesh.positions, {0, 1});
  motion.primitives[0].target_positions[0](2, 1) = std::numeric_limits<float>::infinity();
  try {
    measured(mesh, motion, {0.5});
    ADD_FAILURE() << "nothing is thrown";
  } catch (const BakeError& error) {
    EXPECT_EQ(error.problems()[0].code, "preview.not-finite");
  }
}

TEST(MotionMeasures, StopWhenCancelled) {
  const Mesh mesh = test::tetrahedron();
  Observer observer;
  observer.is_cancelled = [] { return true; };
  EXPECT_THROW(measure_motion(animated(mesh, 2 * mesh.positions, {0, 1}),
                              follow_surface(test::source_of(mesh, "a")), {0, 1}, 1, observer),
               Cancelled);
}

TEST(MotionMeasures, TellOfVerticesThatAreTornApart) {
  const Mesh mesh = test::split_apart(test::sphere(6, 8));
  Positions moved = mesh.positions;
  EXPECT_EQ(measured(mesh, animated(mesh, moved, {0, 1}), {0, 1}).largest_tear, 0);
  moved.row(5) += Eigen::RowVector3d(0, 0.25, 0);
  const MotionMeasures torn = measured(mesh, animated(mesh, moved, {0, 1, 0}), {0, 0.5, 1, 2});
  EXPECT_NEAR(torn.largest_tear, 0.25, 1e-6);
  EXPECT_EQ(torn.tear_time, 1);
}

TEST(MotionMeasures, OfASwellingBallArePowersOfItsRadius) {
  const Mesh ball = test::sphere(48, 64);
  // To twice its size and back: what is expected stays the first frame.
  const MotionMeasures motion =
      measured(ball, animated(ball, 2 * ball.positions, {0, 1, 0}), {0, 0.5, 1, 2});
  ASSERT_EQ(motion.volume.size(), 4U);
  EXPECT_NEAR(motion.volume[0], 4 * std::numbers::pi / 3, 2e-2);
  EXPECT_NEAR(motion.area[0], 4 * std::numbers::pi, 2e-2);
  for (const auto& [i, radius] : {std::pair(0U, 1.0), {1U, 1.5}, {2U, 2.0}, {3U, 1.0}}) {
    EXPECT_NEAR(motion.volume[i] / motion.volume[0], std::pow(radius, 3), 1e-6);
    EXPECT_NEAR(motion.volume_change[i], std::pow(radius, 3) - 1, 1e-6);
    EXPECT_NEAR(motion.area[i] / motion.area[0], std::pow(radius, 2), 1e-6);
    EXPECT_NEAR(motion.area_change[i], std::pow(radius, 2) - 1, 1e-6);
    EXPECT_NEAR(motion.edge_length_change[i], radius - 1, 1e-6);
    EXPECT_NEAR(motion.bend_change[i], 0, 1e-3);
  }
  EXPECT_EQ(furthest_from_zero(motion.volume_change), 2);
}

TEST(MotionMeasures, AreOffTheMixThatIsLinearInTime) {
  const Mesh ball = test::sphere(48, 64);
  const MotionMeasures motion =
      measured(ball, animated(ball, 2 * ball.positions, {0, 1}), {0, 0.5, 1, 7});
  EXPECT_NEAR(motion.volume_change[1], 1.5 * 1.5 * 1.5 - (1 + 8) / 2.0, 1e-6);
  EXPECT_NEAR(motion.area_change[1], 1.5 * 1.5 - (1 + 4) / 2.0, 1e-6);
  EXPECT_NEAR(motion.edge_length_change[1], 0, 1e-6);
  // Beyond the end the last frame stands, and is expected.
  EXPECT_NEAR(motion.volume[3] / motion.volume[0], 8, 1e-6);
  EXPECT_NEAR(motion.volume_change[3], 0, 1e-9);
  // A slow start is part of what is measured: a quarter of the way, where half is expected.
  const MotionMeasures eased =
      measured(ball, animated(ball, 2 * ball.positions, {0, 0.25F, 1}), {1});
  EXPECT_NEAR(eased.edge_length_change[0], 1 - 1.25 / 1.5, 1e-6);
}

TEST(MotionMeasures, OfAHingeAreItsAngleAndItsSides) {
  const Mesh mesh = hinge();
  Positions folded = mesh.positions;
  folded.row(3) << 0, 0, -1;  // a right angle, reached along a straight line
  const MotionMeasures motion = measured(mesh, animated(mesh, folded, {0, 1}), {0.25});
  EXPECT_TRUE(motion.volume.empty());
  EXPECT_NEAR(motion.bend_change[0], 22.5 - std::atan2(0.25, 0.75) * 180 / std::numbers::pi, 1e-5);
  const double side = std::hypot(0.75, 0.25) - 1;
  const double slant = std::hypot(1, std::hypot(0.75, 0.25)) / std::sqrt(2) - 1;
  EXPECT_NEAR(motion.edge_length_change[0], std::sqrt((side * side + slant * slant) / 5), 1e-6);
}

TEST(MotionMeasures, HaveNoAnglesOfALonelyTriangle) {
  Mesh mesh = hinge();
  mesh.triangles = mesh.triangles.topRows(1).eval();
  const MotionMeasures motion =
      measured(mesh, animated(mesh, 2 * mesh.positions, {0, 1}), {0, 0.5});
  EXPECT_TRUE(std::isnan(motion.bend_change[1]));
  EXPECT_EQ(furthest_from_zero(motion.bend_change), -1);
  EXPECT_NEAR(motion.edge_length_change[1], 0, 1e-6);
}

TEST(MotionMeasures, CountEdgesAlongSeamsOnce) {
  const Mesh whole = test::sphere(12, 16);
  const Mesh split = test::split_apart(whole);
  EXPECT_EQ(follow_surface(test::source_of(split, "split")).edges.ends.size(),
            surface_edges(whole.triangles).ends.size());
  const Positions bent = test::bent(whole.positions, 0.2, 3);
  Positions split_bent(split.positions.rows(), 3);
  for (Eigen::Index c = 0; c < split_bent.rows(); ++c) {
    split_bent.row(c) = bent.row(whole.triangles.data()[c]);
  }
  const MotionMeasures a = measured(whole, animated(whole, bent, {0, 1, 0}), {0.5});
  const MotionMeasures b = measured(split, animated(split, split_bent, {0, 1, 0}), {0.5});
  EXPECT_GT(a.edge_length_change[0], 1e-3);
  EXPECT_NEAR(a.volume[0], b.volume[0], 1e-6);
  EXPECT_NEAR(a.edge_length_change[0], b.edge_length_change[0], 1e-6);
  EXPECT_NEAR(a.bend_change[0], b.bend_change[0], 1e-4);
}

TEST(MotionMeasures, AreTheSameOnAnyNumberOfThreads) {
  const Mesh ball = test::sphere(12, 16);
  const AnimatedMesh motion = animated(ball, test::bent(ball.positions, 0.2, 3), {0, 1, 0.3F});
  std::vector<double> times;
  for (int i = 0; i < 21; ++i) times.push_back(i / 10.0);
  const MotionMeasures one = measured(ball, motion, times, 1);
  const MotionMeasures two = measured(ball, motion, times, 2);
  EXPECT_EQ(one.volume, two.volume);
  EXPECT_EQ(one.edge_length_change, two.edge_length_change);
  EXPECT_EQ(one.bend_change, two.bend_change);
}

}  // namespace
}  // namespace morphbake
