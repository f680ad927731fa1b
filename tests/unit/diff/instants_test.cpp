#include "morphbake/diff/instants.h"

#include <gmock/gmock.h>

namespace morphbake {
namespace {

AnimationCurve keys_at(std::vector<float> times) {
  AnimationCurve curve;
  curve.values =
      Eigen::MatrixXf::Zero(static_cast<Eigen::Index>(std::max<std::size_t>(1, times.size())), 1);
  curve.times = std::move(times);
  return curve;
}

std::vector<double> times_of(const std::vector<Instant>& instants) {
  std::vector<double> times;
  for (const Instant& instant : instants) times.push_back(instant.time_a);
  return times;
}

TEST(CommonInstants, OfTwoCurvesWithoutKeysIsOne) {
  EXPECT_EQ(common_instants({keys_at({}), keys_at({})}).size(), 1U);
}

TEST(CommonInstants, AreAllKeysAndTheMiddlesBetween) {
  const AnimationCurve a = keys_at({0, 1}), b = keys_at({0, 0.5F, 2});
  const std::vector<Instant> instants = common_instants({a, b});
  EXPECT_THAT(times_of(instants), testing::ElementsAre(0, 0.25, 0.5, 0.75, 1, 1.5, 2));
  EXPECT_TRUE(instants[0].is_key_a && instants[0].is_key_b);
  EXPECT_TRUE(!instants[1].is_key_a && !instants[1].is_key_b);
  EXPECT_TRUE(!instants[2].is_key_a && instants[2].is_key_b);
}

TEST(CommonInstants, TakeKeysThatDifferByRoundingAsOne) {
  const float third = 1.0F / 3, rounded = std::nextafter(third, 1.0F);
  const AnimationCurve a = keys_at({0, third}), b = keys_at({0, rounded});
  const std::vector<Instant> instants = common_instants({a, b});
  ASSERT_EQ(instants.size(), 3U);
  EXPECT_EQ(instants[2].time_a, static_cast<double>(third));
  EXPECT_EQ(instants[2].time_b, static_cast<double>(rounded));
  EXPECT_TRUE(have_same_keys({a, b}));
  const AnimationCurve later = keys_at({0, third + 1e-4F});
  EXPECT_FALSE(have_same_keys({a, later}));
}

TEST(IsSampled, IsACurveOfFiveEvenKeysOrMore) {
  EXPECT_FALSE(is_sampled(keys_at({0, 1, 2, 3})));
  EXPECT_TRUE(is_sampled(keys_at({0, 1, 2, 3, 4})));
  EXPECT_TRUE(is_sampled(keys_at({0, 1, 2, 3, 4, 4.5F}))) << "a clip may end between two frames";
  EXPECT_FALSE(is_sampled(keys_at({0, 1, 2, 3.5F, 4, 5})));
  EXPECT_FALSE(is_sampled(keys_at({0, 1, 2, 3, 5})));
  AnimationCurve steps = keys_at({0, 1, 2, 3, 4});
  steps.interpolation = Interpolation::Step;
  EXPECT_FALSE(is_sampled(steps));
}

}  // namespace
}  // namespace morphbake
