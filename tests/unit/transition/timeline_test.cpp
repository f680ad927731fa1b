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
  const Edit edit{0, Eigen::Vector2d(0, 1), 1, Fit::None};
  const TransitionState edited =
      apply_edit(T, edit, edit_shares(edit, fixed_fields({d}), 3, {0, 0.8}));
  EXPECT_DOUBLE_EQ(edited(1, 0), 0.8);                        // inside: the amount
  EXPECT_DOUBLE_EQ(edited(1, 1), (1 - 0.6) * 0.5 + 0.6 * 1);  // in the ring: 0.8 (1 - 0.25)
  EXPECT_EQ(edited(1, 2), 1);                                 // outside: unchanged
  EXPECT_EQ(edited(0, 2), 0);
}

TEST(Eased, BezierIsTheCurveOfCss) {
  Easing easing(Ease::Bezier);
  easing.control = {0.25, 0.1, 0.25, 1};  // CSS' "ease"
  EXPECT_EQ(eased(easing, 0), 0);
  EXPECT_EQ(eased(easing, 1), 1);
  EXPECT_NEAR(eased(easing, 0.5), 0.80240339, 1e-8);  // by WebKit's UnitBezier
  easing.control = {1.0 / 3, 1.0 / 3, 2.0 / 3, 2.0 / 3};
  for (const double u : {0.1, 0.4, 0.9}) EXPECT_NEAR(eased(easing, u), u, 1e-12);
}

TEST(ApplyEdit, TakesSharesAnAxis) {
  const Shares to{{0, 1, 0.5}, {1, 0, 0.5}};
  const Edit edit{-1, to, 1, Fit::None};
  TransitionState T = uniform_transition(Shares{{1, 1, 1}, {0, 0, 0}}, 2);
  T = apply_edit(T, edit, edit_shares(edit, {}, 2, {0, 0.5}));
  EXPECT_EQ(T.cols(), 6);
  EXPECT_DOUBLE_EQ(T(1, 0), 0.5);   // x of both vertices goes to the second
  EXPECT_DOUBLE_EQ(T(1, 3), 0);     // y stays
  EXPECT_DOUBLE_EQ(T(1, 5), 0.25);  // z half of it
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
