#include "morphbake/preview/framing.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "morphbake/diagnostics/problem.h"
#include "morphbake/preview/pose.h"
#include "tests/unit/preview/subjects.h"

namespace morphbake {
namespace {

/// The subject's rectangle in the picture, 0 to 1 from the top left, from every vertex.
Eigen::AlignedBox2f rectangle(const AnimatedMesh& mesh, const Framing& framing,
                              const LoopMoment& moment) {
  std::vector<PosedPrimitive> poses;
  pose_mesh(mesh, moment.weights, mesh_to_studio(framing, moment.azimuth), poses);
  const Camera& camera = framing.camera;
  Eigen::AlignedBox2f box;
  for (Eigen::Index v = 0; v + 1 < poses[0].positions.rows(); ++v) {
    const Eigen::Vector3f from = poses[0].positions.row(v).transpose() - camera.position;
    const float depth = from.dot(camera.forward);
    const float x = (from.dot(camera.right) / depth - camera.shift.x()) / camera.half_width;
    const float y = (from.dot(camera.up) / depth - camera.shift.y()) / camera.half_height;
    box.extend(Eigen::Vector2f((1 + x) / 2, (1 - y) / 2));
  }
  return box;
}

/// Largest share of a side that the subject takes in any picture; fails where it comes near the
/// border.
float largest_fill(const AnimatedMesh& mesh, const TurntableOptions& options) {
  const std::vector<LoopMoment> moments = loop_moments(mesh, played_span(mesh), options);
  const Framing framing = frame_motion(mesh, moments, options);
  float largest = 0;
  for (const LoopMoment& moment : moments) {
    const Eigen::AlignedBox2f box = rectangle(mesh, framing, moment);
    EXPECT_GT(box.min().minCoeff(), 0.02f);
    EXPECT_LT(box.max().maxCoeff(), 0.98f);
    largest = std::max(largest, box.sizes().maxCoeff());
  }
  return largest;
}

AnimatedMesh needle(const Eigen::Vector3f& direction) {
  AnimatedMesh mesh = growing_column();
  Float3s& rows = mesh.primitives[0].positions;
  const Eigen::Matrix3f squeeze =
      0.02f * Eigen::Matrix3f::Identity() + direction * direction.transpose();
  rows = (rows * squeeze).eval();
  for (Float3s& target : mesh.primitives[0].target_positions) target.setZero();
  return mesh;
}

TEST(Framing, FillsThePictureAndCutsNothing) {
  for (const double fill : {0.6, 0.75, 0.85}) {
    TurntableOptions options = small_options();
    options.frames = 36;
    options.fill = fill;
    const float largest = largest_fill(growing_column(), options);
    EXPECT_GE(largest, 0.6f);
    EXPECT_LE(largest, fill + 0.002);
  }
}

TEST(Framing, FillsThePictureFromEveryElevation) {
  for (const double elevation : {-80.0, -20.0, 0.0, 12.0, 45.0, 80.0}) {
    TurntableOptions options = small_options();
    options.elevation = elevation;
    EXPECT_NEAR(largest_fill(growing_column(), options), 0.75f, 0.01f) << elevation;
  }
}

TEST(Framing, TakesThinSubjects) {
  const TurntableOptions options = small_options();
  for (int axis = 0; axis < 3; ++axis) {
    EXPECT_NEAR(largest_fill(needle(Eigen::Vector3f::Unit(axis)), options), 0.75f, 0.01f) << axis;
  }
}

TEST(Framing, TakesWideAndTallPictures) {
  for (const auto& [width, height] : {std::pair{400, 100}, std::pair{100, 400}}) {
    TurntableOptions options = small_options();
    options.width = width;
    options.height = height;
    EXPECT_NEAR(largest_fill(growing_column(), options), 0.75f, 0.01f) << width;
  }
}

TEST(Framing, TakesWideAndNarrowAngles) {
  for (const double angle : {2.0, 24.0, 90.0}) {
    TurntableOptions options = small_options();
    options.field_of_view = angle;
    const float largest = largest_fill(growing_column(), options);
    EXPECT_GE(largest, 0.6f) << angle;
    EXPECT_LE(largest, 0.755f) << angle;
  }
}

TEST(Framing, FloorTouchesThePoseOrTheWholeMotion) {
  const AnimatedMesh mesh = growing_column();
  TurntableOptions options = small_options();
  for (const bool follows : {true, false}) {
    options.floor_follows = follows;
    const std::vector<LoopMoment> moments = loop_moments(mesh, played_span(mesh), options);
    const Framing framing = frame_motion(mesh, moments, options);
    std::vector<PosedPrimitive> poses;
    for (std::size_t i = 0; i < moments.size(); ++i) {
      pose_mesh(mesh, moments[i].weights, mesh_to_studio(framing, moments[i].azimuth), poses);
      const Eigen::Index count = poses[0].positions.rows() - 1;
      // This subject's lowest point stays where it is.
      EXPECT_NEAR(framing.floors[i], poses[0].positions.topRows(count).col(1).minCoeff(), 1e-5);
    }
  }
}

TEST(Framing, SideBySideHasOneCameraOneScaleAndOneGround) {
  // A column, and one of half its size that lies elsewhere in its scene.
  const AnimatedMesh large = growing_column();
  AnimatedMesh small = growing_column();
  small.to_scene.topLeftCorner<3, 3>() *= 0.5;
  small.primitives[0].positions.rowwise() += Eigen::RowVector3f(5, -7, 9);
  const TurntableOptions options = small_options();
  const std::vector<LoopMoment> moments = loop_moments(large, played_span(large), options);
  const std::vector<Framing> framings =
      frame_side_by_side({{"large", large, moments}, {"small", small, moments}}, options);
  ASSERT_EQ(framings.size(), 2U);
  EXPECT_EQ(framings[0].camera.position, framings[1].camera.position);
  EXPECT_EQ(framings[0].camera.shift, framings[1].camera.shift);
  EXPECT_NEAR(framings[1].mesh_to_table.linear()(0, 0) / framings[0].mesh_to_table.linear()(0, 0),
              0.5, 1e-6);
  // Both stand on the ground at first, and are seen whole.
  EXPECT_NEAR(framings[0].floors[0], framings[1].floors[0], 1e-5);
  Eigen::AlignedBox2f first, second;
  for (const LoopMoment& moment : moments) {
    first.extend(rectangle(large, framings[0], moment));
    second.extend(rectangle(small, framings[1], moment));
  }
  EXPECT_GT(first.min().minCoeff(), 0.02f);
  EXPECT_LT(first.max().maxCoeff(), 0.98f);
  EXPECT_TRUE(first.contains(second));
  const Eigen::AlignedBox2f large_box = rectangle(large, framings[0], moments[0]);
  const Eigen::AlignedBox2f small_box = rectangle(small, framings[1], moments[0]);
  EXPECT_NEAR(large_box.center().x(), small_box.center().x(), 1e-3);
  EXPECT_NEAR(small_box.sizes().x() / large_box.sizes().x(), 0.5, 0.03);
}

TEST(Framing, SideBySideNamesTheFileThatIsNotFinite) {
  const AnimatedMesh good = growing_column();
  AnimatedMesh bad = good;
  bad.primitives[0].target_positions[0](7, 1) = std::numeric_limits<float>::infinity();
  const std::vector<LoopMoment> moments = loop_moments(good, played_span(good), small_options());
  try {
    frame_side_by_side({{"good.glb", good, moments}, {"bad.glb", bad, moments}}, small_options());
    ADD_FAILURE() << "nothing is thrown";
  } catch (const BakeError& error) {
    EXPECT_EQ(error.problems()[0].location.file, "bad.glb");
  }
}

TEST(Motion, PlaysToTheEndAndBackUnlessItEndsAsItBegins) {
  AnimatedMesh mesh = growing_column();
  mesh.weights.times = {2, 4};
  EXPECT_DOUBLE_EQ(time_at(played_span(mesh), 0.25), 3);
  EXPECT_DOUBLE_EQ(time_at(played_span(mesh), 0.75), 3);
  mesh.weights.values << 1, 1;
  EXPECT_DOUBLE_EQ(time_at(played_span(mesh), 0.75), 3.5);
}

TEST(Motion, HasOneClockForSeveralMeshes) {
  AnimatedMesh brief = growing_column(), late = growing_column(), cycle = growing_column();
  brief.weights.times = {0, 1};
  late.weights.times = {1, 4};
  cycle.weights.values << 1, 1;
  const auto span_of = [](const std::vector<AnimatedMesh>& meshes) {
    std::vector<PlayedSpan> spans;
    for (const AnimatedMesh& mesh : meshes) spans.push_back(played_span(mesh));
    return common_span(spans);
  };
  const PlayedSpan span = span_of({brief, late});
  EXPECT_DOUBLE_EQ(span.begin, 0);
  EXPECT_DOUBLE_EQ(span.end, 4);
  EXPECT_TRUE(span.returns);
  EXPECT_TRUE(span_of({cycle, brief}).returns);
  EXPECT_FALSE(span_of({cycle, cycle}).returns);

  TurntableOptions options;
  options.frames = 4;
  const std::vector<LoopMoment> moments = loop_moments(brief, span, options);
  ASSERT_EQ(moments.size(), 4U);
  EXPECT_DOUBLE_EQ(moments[1].time, 2);
  EXPECT_DOUBLE_EQ(moments[1].weights(0), 1);  // it stays at its end
  EXPECT_DOUBLE_EQ(loop_moments(late, span, options)[0].weights(0), 0);
}

TEST(Motion, TurnsRoundOrSwings) {
  TurntableOptions options;
  options.azimuth = 10;
  options.orbit = -720;
  EXPECT_DOUBLE_EQ(orbit_azimuth(options, 0.25), -170);
  options.orbit = 80;
  EXPECT_NEAR(orbit_azimuth(options, 0), 10, 1e-9);
  EXPECT_NEAR(orbit_azimuth(options, 0.25), 50, 1e-9);
  EXPECT_NEAR(orbit_azimuth(options, 0.75), -30, 1e-9);
  options.orbit = 0;
  EXPECT_DOUBLE_EQ(orbit_azimuth(options, 0.4), 10);
}

TEST(Pose, TurnsNormalsWithAScaledTransform) {
  AnimatedPrimitive primitive = sphere({0, 0, 0});
  Eigen::Affine3d squash = Eigen::Affine3d::Identity();
  squash.linear().diagonal() << 1, 0.25, 1;
  PosedPrimitive pose;
  pose_primitive(primitive, {}, squash, pose);
  for (Eigen::Index v = 0; v < pose.normals.rows(); ++v) {
    const Eigen::Vector3f p = primitive.positions.row(v).transpose();
    const Eigen::Vector3f expected = Eigen::Vector3f(p.x(), 4 * p.y(), p.z()).normalized();
    EXPECT_LT((pose.normals.row(v).transpose() - expected).norm(), 1e-5f);
  }
}

}  // namespace
}  // namespace morphbake
