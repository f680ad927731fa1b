#include "morphbake/diff/motion_difference.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <numbers>

#include "morphbake/gltf/morphed_rows.h"
#include "unit/diff/moving_mesh.h"

namespace morphbake {
namespace {

constexpr double kDiagonal = 3.4641016;  // of the unit sphere's box

struct Compared {
  MotionDifference motion;
  VertexDifferences vertices;
};

Compared compare(const AnimatedMesh& a, const AnimatedMesh& b, const MotionOptions& options = {}) {
  const TargetRows of_a(a), of_b(b);
  const MeshPair meshes{{a, of_a}, {b, of_b}, {0}};
  Compared compared{{}, no_differences(meshes)};
  compared.motion = compare_motions(meshes, {a.weights, b.weights}, options, compared.vertices, {});
  return compared;
}

/// What the definition says, without blocks, threads or shortcuts.
double plain_difference(const AnimatedMesh& a, const AnimatedMesh& b) {
  double largest = 0;
  for (const Instant& instant : common_instants({a.weights, b.weights})) {
    const Positions apart = morphed_positions(a, weights_at(a, instant.time_a)) -
                            morphed_positions(b, weights_at(b, instant.time_b));
    largest = std::max(largest, apart.rowwise().norm().maxCoeff());
  }
  return largest;
}

TEST(CompareMotions, FindsOneVertexOfOneFrameOfAHundredAndTwenty) {
  const AnimatedMesh a = by_frames(120);
  AnimatedMesh b = a;
  b.primitives[0].target_positions[70](33, 1) += static_cast<float>(2e-5 * kDiagonal);
  const LargestDifference worst = compare(a, b).motion.position;
  EXPECT_NEAR(worst.value, 2e-5 * kDiagonal, 1e-7);
  EXPECT_GT(worst.value, 1e-5 * kDiagonal);
  EXPECT_EQ(worst.vertex, 33);
  EXPECT_EQ(worst.primitive, 0);
  EXPECT_FLOAT_EQ(static_cast<float>(worst.time), a.weights.times[71]);
}

TEST(CompareMotions, FindsThatVertexAlsoAgainstAnotherBasis) {
  const AnimatedMesh a = by_one_target(1000);
  AnimatedMesh b = by_frames(120);
  b.primitives[0].target_positions[70](33, 1) += static_cast<float>(2e-5 * kDiagonal);
  const LargestDifference worst = compare(a, b).motion.position;
  EXPECT_GT(worst.value, 1e-5 * kDiagonal);
  EXPECT_EQ(worst.vertex, 33);
}

TEST(CompareMotions, LetsAnotherBasisOfAnEasedMotionPass) {
  for (const int frames : {6, 24, 120}) {
    for (const int keys : {50, 400}) {
      const AnimatedMesh a = by_one_target(keys), b = by_frames(frames);
      EXPECT_LT(compare(a, b).motion.position.value, 1e-5 * kDiagonal) << frames << " " << keys;
      EXPECT_LT(compare(b, a).motion.position.value, 1e-5 * kDiagonal) << frames << " " << keys;
    }
  }
}

TEST(CompareMotions, WithoutAllowanceForSamplingTellsWhatChordsCutOff) {
  const AnimatedMesh a = by_one_target(400), b = by_frames(24);
  const double strict = compare(a, b, {.allows_sampling = false}).motion.position.value;
  EXPECT_NEAR(strict, plain_difference(a, b), 1e-12);
  EXPECT_GT(strict, 1e-5 * kDiagonal);
}

TEST(CompareMotions, AllowsNothingBetweenFramesThatBothHave) {
  const AnimatedMesh a = by_frames(24);
  AnimatedMesh b = a;
  b.primitives[0].target_positions[10].col(0).array() += 0.01F;
  const Compared compared = compare(a, b);
  EXPECT_EQ(compared.motion.position.sampling, 0);
  EXPECT_NEAR(compared.motion.position.value, 0.01, 1e-6);
  EXPECT_NEAR(compared.motion.position.value, plain_difference(a, b), 1e-12);
}

TEST(CompareMotions, AMotionThatRunsLateIsFoundThoughFramesAreSampled) {
  const AnimatedMesh a = by_one_target(400);
  AnimatedMesh b = by_frames(24);
  for (float& time : b.weights.times) time *= 1.05F;
  EXPECT_GT(compare(a, b).motion.position.value, 1e-3);
}

TEST(CompareMotions, GivesTheSameBitsWithAnyNumberOfThreads) {
  const AnimatedMesh a = by_frames(24);
  AnimatedMesh b = a;
  for (Float3s& target : b.primitives[0].target_positions) {
    target += 1e-3F * Float3s::Random(target.rows(), 3);
  }
  const Compared one = compare(a, b, {.threads = 1}), two = compare(a, b, {.threads = 2});
  EXPECT_EQ(one.motion.position.value, two.motion.position.value);
  EXPECT_EQ(one.motion.position.vertex, two.motion.position.vertex);
  EXPECT_TRUE(one.vertices.distance == two.vertices.distance);
}

TEST(CompareMotions, SeesTheTransformOfTheNode) {
  const AnimatedMesh a = by_one_target(10);
  AnimatedMesh b = a;
  b.primitives[0].positions /= 2;
  b.primitives[0].target_positions[0] /= 2;
  b.to_scene.topLeftCorner<3, 3>() *= 2;
  EXPECT_LT(compare(a, b).motion.position.value, 1e-6);
  EXPECT_LT(compare(a, b).motion.normal.value, 1e-4);
  b.to_scene(0, 3) = 0.25;
  EXPECT_NEAR(compare(a, b).motion.position.value, 0.25, 1e-6);
}

TEST(CompareMotions, MeasuresNormalsByTheirAngle) {
  const AnimatedMesh a = still_sphere();
  AnimatedMesh b = a;
  const Eigen::Matrix3f turn = Eigen::AngleAxisf(0.5F, Eigen::Vector3f::UnitX()).toRotationMatrix();
  b.primitives[0].normals.row(5) =
      3 * (turn * Eigen::Vector3f::UnitY()).transpose();  // its length does not count
  AnimatedMesh with_axis = a;
  with_axis.primitives[0].normals.row(5) = Eigen::RowVector3f::UnitY();
  const Compared compared = compare(with_axis, b);
  EXPECT_NEAR(compared.motion.normal.value, 0.5 * 180 / std::numbers::pi, 1e-4);
  EXPECT_EQ(compared.motion.normal.vertex, 5);
  b.primitives[0].normals = -a.primitives[0].normals;
  EXPECT_NEAR(compare(a, b).motion.normal.value, 180, 1e-3);
}

TEST(CompareMotions, TellsTinyAnglesApart) {
  AnimatedMesh a = still_sphere(), b = a;
  const double angle = 1e-4;
  a.primitives[0].normals.row(0) = Eigen::RowVector3f::UnitY();
  b.primitives[0].normals.row(0) = Eigen::RowVector3f(std::sin(1e-4F), std::cos(1e-4F), 0);
  EXPECT_NEAR(compare(a, b).motion.normal.value, angle * 180 / std::numbers::pi, 1e-6);
}

TEST(CompareMotions, NormalsWithoutDirectionAreEqualToEachOtherOnly) {
  AnimatedMesh a = still_sphere();
  a.primitives[0].normals.row(0).setZero();
  EXPECT_EQ(compare(a, a).motion.normal.value, 0);
  EXPECT_NEAR(compare(a, still_sphere()).motion.normal.value, 90, 1e-9);
}

TEST(CompareMotions, OfNumbersThatOverflowIsVeryLargeAndNeverNothing) {
  const AnimatedMesh a = by_one_target(10);
  AnimatedMesh b = a;
  b.to_scene(0, 0) = 1e300;
  b.to_scene(1, 0) = -1e300;
  EXPECT_GT(compare(a, b).motion.position.value, 1e299);
}

TEST(CompareMotions, StopsWhenAsked) {
  const AnimatedMesh a = by_frames(24);
  const TargetRows targets(a);
  const MeshPair meshes{{a, targets}, {a, targets}, {0}};
  VertexDifferences vertices = no_differences(meshes);
  Observer observer;
  observer.is_cancelled = [] { return true; };
  EXPECT_THROW(compare_motions(meshes, {a.weights, a.weights}, {}, vertices, observer), Cancelled);
}

}  // namespace
}  // namespace morphbake
