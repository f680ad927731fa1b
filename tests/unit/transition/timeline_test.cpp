#include "morphbake/transition/timeline.h"

#include <gtest/gtest.h>

namespace morphbake {
namespace {

TEST(Eased, EndsAndMiddles) {
  for (const Ease ease : {Ease::Linear, Ease::Step, Ease::Smoothstep, Ease::Cubic}) {
    EXPECT_EQ(eased(ease, 0), 0);
    EXPECT_EQ(eased(ease, 1), 1);
    EXPECT_EQ(eased(ease, -3), 0);
    EXPECT_EQ(eased(ease, 3), 1);
  }
  EXPECT_EQ(eased(Ease::Step, 0.999), 0);
  EXPECT_DOUBLE_EQ(eased(Ease::Smoothstep, 0.25), 0.15625);
  EXPECT_DOUBLE_EQ(eased(Ease::Cubic, 0.25), 0.0625);
  EXPECT_DOUBLE_EQ(eased(Ease::Cubic, 0.75), 0.9375);
}

TEST(ApplyEdit, IsEquationSeven) {
  TransitionState T(2, 3);
  T << 1, 0.5, 0, 0, 0.5, 1;
  const Eigen::VectorXd d = Eigen::Vector3d(0, 0.25, 1);
  const TransitionState edited = apply_edit(T, {0, {0, 1}, 1}, 0.8, {d});
  EXPECT_DOUBLE_EQ(edited(1, 0), 0.8);                        // inside: the amount
  EXPECT_DOUBLE_EQ(edited(1, 1), (1 - 0.6) * 0.5 + 0.6 * 1);  // in the ring: 0.8 (1 - 0.25)
  EXPECT_EQ(edited(1, 2), 1);                                 // outside: unchanged
  EXPECT_EQ(edited(0, 2), 0);
}

TEST(FrameTimes, EndWithTheDuration) {
  Timeline timeline;
  timeline.frames_per_second = 30;
  timeline.duration = 4;
  EXPECT_EQ(frame_times(timeline).size(), 121U);
  EXPECT_EQ(frame_times(timeline).back(), 4);
  timeline.duration = 1.01;
  EXPECT_EQ(frame_times(timeline).size(), 32U);
  EXPECT_EQ(frame_times(timeline).back(), 1.01);
  timeline.duration = 0.001;
  EXPECT_EQ(frame_times(timeline), (std::vector<double>{0, 0.001}));
}

}  // namespace
}  // namespace morphbake
