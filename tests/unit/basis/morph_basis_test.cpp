#include "morphbake/basis/morph_basis.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "morphbake/gltf/animated_mesh.h"
#include "morphbake/mesh/measures.h"
#include "shapes/shapes.h"

namespace morphbake {
namespace {

/// One whole-surface track over a sphere that moves by 1 unit.
struct OneTrack {
  Timeline timeline;
  SeparableTimeline separable;
  SolvedShapes shapes;

  std::vector<Clip> clips = {{"all", 0, 2}};

  explicit OneTrack(Ease ease, double begin = 0.5, double end = 1.5) {
    const Mesh mesh = test::sphere(8, 10);
    timeline.duration = 2;
    timeline.frames_per_second = 10;
    timeline.tracks = {{"grow", {-1, Eigen::Vector2d(0, 1), 1, Fit::None}, begin, end, ease}};
    const Eigen::MatrixXd none = Eigen::MatrixXd::Zero(2, mesh.positions.rows());
    separable.fields = {{"start", none, {}}, {"grow", none, {0}}};
    shapes.base = mesh.positions;
    shapes.names = {"grow"};
    shapes.displacements = {Positions::Constant(mesh.positions.rows(), 3, 1 / std::sqrt(3.0))};
  }
};

double key_error(const OneTrack& track, const MorphBasis& basis) {
  double error = 0;
  for (int step = 0; step <= 1460; ++step) {
    const double time = step / 730.0;
    const double exact = field_coefficients(track.timeline, track.separable, time)(1);
    error = std::max(
        error,
        std::abs(interpolate_keys(basis.clips[0].times, basis.clips[0].weights, time)(0) - exact));
  }
  return error;
}

TEST(TrackBasis, KeysFollowTheEasingWithinTheTolerance) {
  for (const Ease ease : {Ease::Linear, Ease::Smoothstep, Ease::Cubic}) {
    const OneTrack track(ease);
    const double diagonal = bounding_diagonal(track.shapes.base);
    const MorphBasis fine =
        track_basis(track.shapes, track.separable, track.timeline, track.clips, {1e-6});
    const MorphBasis coarse =
        track_basis(track.shapes, track.separable, track.timeline, track.clips, {1e-2});
    EXPECT_LT(key_error(track, fine), 1.5e-6 * diagonal);
    EXPECT_LT(key_error(track, coarse), 1.5e-2 * diagonal);
    EXPECT_LE(coarse.clips[0].times.size(), fine.clips[0].times.size());
  }
}

TEST(TrackBasis, LinearEasingNeedsOnlyItsCorners) {
  const OneTrack track(Ease::Linear);
  const MorphBasis basis =
      track_basis(track.shapes, track.separable, track.timeline, track.clips, {});
  EXPECT_EQ(basis.clips[0].times, (std::vector<float>{0, 0.5F, 1.5F, 2}));
}

TEST(TrackBasis, AStepTakesOneStepOfTheClock) {
  const OneTrack track(Ease::Step, 0.25, 1);
  const MorphBasis basis =
      track_basis(track.shapes, track.separable, track.timeline, track.clips, {});
  const auto jump = std::find(basis.clips[0].times.begin(), basis.clips[0].times.end(), 1.0F);
  ASSERT_NE(jump, basis.clips[0].times.end());
  EXPECT_EQ(*(jump - 1), std::nextafter(1.0F, 0.0F));
  const auto row = jump - basis.clips[0].times.begin();
  EXPECT_EQ(basis.clips[0].weights(row - 1, 0), 0);
  EXPECT_EQ(basis.clips[0].weights(row, 0), 1);
  EXPECT_TRUE(std::is_sorted(basis.clips[0].times.begin(), basis.clips[0].times.end()));
}

TEST(TrackBasis, ClipsShowTheirPartsFromZeroOn) {
  OneTrack track(Ease::Smoothstep);
  track.clips = {{"rise", 0.5, 1.5}, {"end of the rise", 1.2, 2}};
  const MorphBasis basis =
      track_basis(track.shapes, track.separable, track.timeline, track.clips, {1e-6});
  ASSERT_EQ(basis.clips.size(), 2U);
  for (std::size_t c = 0; c < 2; ++c) {
    const WeightKeys& keys = basis.clips[c];
    const double begin = track.clips[c].begin;
    EXPECT_EQ(keys.times.front(), 0);
    EXPECT_EQ(keys.times.back(), static_cast<float>(track.clips[c].end - begin));
    EXPECT_EQ(std::ranges::adjacent_find(keys.times, std::greater_equal<>()), keys.times.end());
    for (double time = 0; time < track.clips[c].end - begin; time += 0.01) {
      const double exact = field_coefficients(track.timeline, track.separable, begin + time)(1);
      EXPECT_NEAR(interpolate_keys(keys.times, keys.weights, time)(0), exact, 1e-5);
    }
  }
}

TEST(TrackBasis, AClipMayBeginWithAJump) {
  OneTrack track(Ease::Step, 0.25, 1.1);
  track.clips = {{"before", 0, 1.1}, {"after", 1.1, 2}};
  const MorphBasis basis =
      track_basis(track.shapes, track.separable, track.timeline, track.clips, {});
  EXPECT_EQ(basis.clips[0].weights(0, 0), 0);
  EXPECT_EQ(basis.clips[1].weights(0, 0), 1);
}

TEST(TrackBasis, NamesAreUniqueAndShortEnough) {
  OneTrack track(Ease::Linear);
  const std::string longest(63, 'n');
  track.shapes.names = {longest + "+a", longest + "+b", "ok"};
  track.shapes.displacements.resize(3, track.shapes.displacements[0]);
  track.separable.fields.resize(4, track.separable.fields[1]);
  const MorphBasis basis =
      track_basis(track.shapes, track.separable, track.timeline, track.clips, {});
  EXPECT_EQ(basis.targets[0].name, longest);
  EXPECT_EQ(basis.targets[1].name.size(), 63U);
  EXPECT_NE(basis.targets[0].name, basis.targets[1].name);
  EXPECT_EQ(basis.targets[2].name, "ok");
}

/// What a viewer shows at weights `w`.
Positions combine_targets(const MorphBasis& basis, const Eigen::VectorXd& w) {
  Positions positions = basis.base;
  for (std::size_t k = 0; k < basis.targets.size(); ++k) {
    const double weight = w(static_cast<Eigen::Index>(k));
    if (weight != 0) positions += weight * basis.targets[k].displacement;
  }
  return positions;
}

TEST(FrameBasis, ClipsMayBeginBetweenFrames) {
  OneTrack track(Ease::Linear);
  track.clips = {{"part", 0.95, 1.23}};
  const FrameSource frames = combined_frames(track.shapes, track.separable, track.timeline);
  const MorphBasis basis = frame_basis(frames, track.clips);
  const WeightKeys& keys = basis.clips[0];
  for (const double time : {0.0, 0.05, 0.1, 0.28}) {
    const Positions exact = combine_shapes(
        track.shapes, field_coefficients(track.timeline, track.separable, 0.95 + time));
    EXPECT_LT(largest_distance(
                  combine_targets(basis, interpolate_keys(keys.times, keys.weights, time)), exact),
              1e-6);
  }
}

TEST(FrameBasis, HoldsEveryFrame) {
  const OneTrack track(Ease::Smoothstep);
  const FrameSource frames = combined_frames(track.shapes, track.separable, track.timeline);
  const MorphBasis basis = frame_basis(frames, track.clips);
  const std::vector<double> times = frame_times(track.timeline);
  ASSERT_EQ(basis.targets.size() + 1, times.size());
  EXPECT_TRUE(basis.clips[0].weights.row(0).isZero(0));
  for (const double time : times) {
    const Positions exact =
        combine_shapes(track.shapes, field_coefficients(track.timeline, track.separable, time));
    const auto weights =
        interpolate_keys(basis.clips[0].times, basis.clips[0].weights, static_cast<float>(time));
    EXPECT_LT(largest_distance(combine_targets(basis, weights), exact), 1e-6);
  }
}

}  // namespace
}  // namespace morphbake
