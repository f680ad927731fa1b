#include "morphbake/sources/source_mesh.h"

#include <gtest/gtest.h>

#include <array>
#include <map>
#include <random>

namespace morphbake {
namespace {

TEST(WeldRows, JoinsExactlyEqualPoints) {
  Positions rows(5, 3);
  rows << 0, 0, 0, 1, 0, 0, -0.0, 0, 0, 1, 0, 1e-300, 1, 0, 0;
  int count = 0;
  EXPECT_EQ(weld_rows(rows, count), (std::vector<int>{0, 1, 0, 2, 1}));
  EXPECT_EQ(count, 3);
}

TEST(WeldRows, AgreesWithAMapWhereHashesCollide) {
  // Of 400,000 random points about twenty pairs share 32 bits of hash; half of the rows are twins.
  constexpr int kPoints = 400000;
  std::mt19937_64 random(1);
  Positions rows(2 * kPoints, 3);
  for (int i = 0; i < kPoints; ++i) {
    for (int axis = 0; axis < 3; ++axis) rows(i, axis) = static_cast<double>(random());
  }
  for (int i = 0; i < kPoints; ++i) rows.row(kPoints + i) = rows.row((7 * i) % kPoints);
  std::map<std::array<double, 3>, int> numbers;
  std::vector<int> expected;
  for (Eigen::Index i = 0; i < rows.rows(); ++i) {
    const std::array point = {rows(i, 0), rows(i, 1), rows(i, 2)};
    expected.push_back(numbers.emplace(point, static_cast<int>(numbers.size())).first->second);
  }
  int count = 0;
  EXPECT_EQ(weld_rows(rows, count), expected);
  EXPECT_EQ(count, static_cast<int>(numbers.size()));
}

}  // namespace
}  // namespace morphbake
