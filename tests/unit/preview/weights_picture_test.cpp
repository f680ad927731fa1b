#include "morphbake/preview/weights_picture.h"

#include <gtest/gtest.h>

#include <set>

namespace morphbake {
namespace {

AnimationCurve ramps(int targets, int keys) {
  AnimationCurve curve;
  curve.values = Eigen::MatrixXf::Zero(keys, targets);
  for (int k = 0; k < keys; ++k) {
    curve.times.push_back(static_cast<float>(k) / 10);
    curve.values(k, k % targets) = 1;
  }
  return curve;
}

std::vector<std::string> names_of(int targets) {
  std::vector<std::string> names;
  for (int t = 0; t < targets; ++t) names.push_back("target " + std::to_string(t));
  return names;
}

int colours_in(const Image& image) {
  std::set<std::array<std::uint8_t, 3>> colours;
  for (std::size_t i = 0; i < image.rgb.size(); i += 3) {
    colours.insert({image.rgb[i], image.rgb[i + 1], image.rgb[i + 2]});
  }
  return static_cast<int>(colours.size());
}

TEST(WeightsPicture, GivesEachTargetAStrip) {
  const Image few = draw_weights(ramps(3, 30), names_of(3), "few");
  const Image many = draw_weights(ramps(40, 200), names_of(40), "many");
  EXPECT_EQ(few.width, 1200);
  EXPECT_LT(few.height, many.height);
  EXPECT_GT(colours_in(many), colours_in(few));
}

TEST(WeightsPicture, IsTheSameEachTime) {
  EXPECT_EQ(draw_weights(ramps(3, 30), names_of(3), "a").rgb,
            draw_weights(ramps(3, 30), names_of(3), "a").rgb);
}

TEST(WeightsPicture, EndsWellForOddCurves) {
  AnimationCurve rest;
  rest.values = Eigen::MatrixXf::Constant(1, 2, -3.0F);
  EXPECT_GT(draw_weights(rest, {"", "\x1b[31m"}, "rest").height, 0);
  EXPECT_GT(draw_weights({}, {}, "none").height, 0);
  const Image cut = draw_weights(ramps(600, 3), names_of(600), "cut");
  EXPECT_LT(cut.height, 500 * 25 + 200);
  AnimationCurve moment = ramps(1, 1);
  EXPECT_GT(draw_weights(moment, {"one"}, std::string(500, 'x')).height, 0);
}

}  // namespace
}  // namespace morphbake
