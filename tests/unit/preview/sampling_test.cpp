#include "morphbake/preview/sampling.h"

#include <gtest/gtest.h>

#include <array>

namespace morphbake {
namespace {

TEST(SamplePattern, GivesEverySquareOfPixelsAllCells) {
  const SamplePattern pattern = make_sample_pattern(3);
  for (const auto& [left, top] : {std::pair{0, 0}, std::pair{5, 2}, std::pair{7, 11}}) {
    std::array<int, 16> seen{};
    for (int y = top; y < top + kPatternSide; ++y) {
      for (int x = left; x < left + kPatternSide; ++x) ++seen[pattern.first_of_pixel(x, y) / 3];
    }
    for (const int count : seen) EXPECT_EQ(count, 1);
  }
}

TEST(SamplePattern, IsCosineDistributed) {
  const SamplePattern pattern = make_sample_pattern(16);
  Eigen::Vector3f mean = Eigen::Vector3f::Zero();
  for (const Eigen::Vector3f& direction : pattern.hemisphere) {
    EXPECT_NEAR(direction.norm(), 1, 1e-5f);
    EXPECT_GE(direction.z(), 0);
    mean += direction / static_cast<float>(pattern.hemisphere.size());
  }
  EXPECT_LT((mean - Eigen::Vector3f(0, 0, 2.0f / 3)).norm(), 0.02f);
}

TEST(PerpendicularAxes, FormABasisForEveryNormal) {
  for (const Eigen::Vector3f& raw :
       {Eigen::Vector3f(0, 0, 1), Eigen::Vector3f(0, 0, -1), Eigen::Vector3f(1, 0, 0),
        Eigen::Vector3f(0.3f, -0.8f, -0.2f), Eigen::Vector3f(1e-4f, 0, -1)}) {
    const Eigen::Vector3f normal = raw.normalized();
    Eigen::Matrix3f basis;
    Eigen::Vector3f a, b;
    perpendicular_axes(normal, a, b);
    basis << a, b, normal;
    EXPECT_LT((basis.transpose() * basis - Eigen::Matrix3f::Identity()).norm(), 1e-5f);
  }
}

}  // namespace
}  // namespace morphbake
