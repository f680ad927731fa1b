#include "morphbake/landmarks/assignment.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <random>

namespace morphbake {
namespace {

TEST(Assign, NothingToNothing) {
  EXPECT_TRUE(assign(Eigen::MatrixXd(0, 0), 1).empty());
  EXPECT_EQ(assign(Eigen::MatrixXd(2, 0), 1), (std::vector<int>{-1, -1}));
  EXPECT_TRUE(assign(Eigen::MatrixXd(0, 2), 1).empty());
}

TEST(Assign, LeavesAloneWhatCostsMoreThanTwoAlone) {
  Eigen::MatrixXd cost(2, 2);
  cost << 1, 9, 9, 2.1;
  EXPECT_EQ(assign(cost, 1), (std::vector<int>{0, -1}));
}

TEST(Assign, TheGreedyChoiceIsNotAlwaysBest) {
  Eigen::MatrixXd cost(2, 3);
  cost << 1, 2, 9, 2, 9, 9;
  EXPECT_EQ(assign(cost, 100), (std::vector<int>{1, 0}));
}

TEST(Assign, IsTheBestOfAllPermutations) {
  std::mt19937 random(7);
  for (int trial = 0; trial < 50; ++trial) {
    Eigen::MatrixXd cost(5, 5);
    for (double& each : cost.reshaped()) each = static_cast<double>(random() % 1000);
    std::vector<int> order(5);
    std::iota(order.begin(), order.end(), 0);
    const auto total = [&](const std::vector<int>& columns) {
      double sum = 0;
      for (int i = 0; i < 5; ++i) sum += cost(i, columns[static_cast<std::size_t>(i)]);
      return sum;
    };
    double least = 1e9;
    do {
      least = std::min(least, total(order));
    } while (std::next_permutation(order.begin(), order.end()));
    EXPECT_EQ(total(assign(cost, 1e6)), least);
  }
}

}  // namespace
}  // namespace morphbake
