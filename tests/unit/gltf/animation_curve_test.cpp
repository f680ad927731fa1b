#include <gtest/gtest.h>

#include "morphbake/gltf/animated_mesh.h"

namespace morphbake {
namespace {

AnimationCurve two_keys(Interpolation interpolation) {
  AnimationCurve curve;
  curve.interpolation = interpolation;
  curve.times = {1, 3};
  curve.values.resize(2, 1);
  curve.values << 2, 6;
  return curve;
}

TEST(AnimationCurve, IsConstantBeforeTheFirstKeyAndAfterTheLast) {
  for (const Interpolation interpolation : {Interpolation::Linear, Interpolation::Step}) {
    const AnimationCurve curve = two_keys(interpolation);
    EXPECT_EQ(value_at(curve, -5)(0), 2);
    EXPECT_EQ(value_at(curve, 1)(0), 2);
    EXPECT_EQ(value_at(curve, 3)(0), 6);
    EXPECT_EQ(value_at(curve, 9)(0), 6);
  }
}

TEST(AnimationCurve, RunsStraightOrStaysBetweenKeys) {
  EXPECT_DOUBLE_EQ(value_at(two_keys(Interpolation::Linear), 1.5)(0), 3);
  EXPECT_EQ(value_at(two_keys(Interpolation::Step), 2.99)(0), 2);
}

// A cubic spline repeats every cubic polynomial whose values and slopes it is given.
TEST(AnimationCurve, CubicSplineIsTheCubicOfItsTangents) {
  const auto cubic = [](double t) { return t * t * t - 2 * t * t + 3; };
  const auto slope = [](double t) { return 3 * t * t - 4 * t; };
  AnimationCurve curve = two_keys(Interpolation::CubicSpline);
  curve.values << static_cast<float>(cubic(1)), static_cast<float>(cubic(3));
  curve.in_tangents.resize(2, 1);
  curve.in_tangents << 100, static_cast<float>(slope(3));
  curve.out_tangents.resize(2, 1);
  curve.out_tangents << static_cast<float>(slope(1)), -100;
  for (const double t : {1.0, 1.25, 2.0, 2.9, 3.0}) {
    EXPECT_NEAR(value_at(curve, t)(0), cubic(t), 1e-12) << t;
  }
}

TEST(AnimationCurve, WithoutKeysTheFirstRowStands) {
  AnimationCurve curve;
  curve.values.resize(1, 2);
  curve.values << 0.25F, 0.5F;
  EXPECT_EQ(value_at(curve, 7), Eigen::Vector2d(0.25, 0.5));
}

}  // namespace
}  // namespace morphbake
