#include "morphbake/mesh/orientation.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "shapes/shapes.h"

namespace morphbake {
namespace {

void turn(Triangles& triangles, Eigen::Index f) { std::swap(triangles(f, 1), triangles(f, 2)); }

/// The triangles that are told to be turned.
std::vector<int> turned(const Triangles& triangles) {
  std::vector<int> found;
  const Orientation orientation = find_orientation(triangles);
  for (int f = 0; f < triangles.rows(); ++f) {
    if (orientation.is_turned[static_cast<std::size_t>(f)] != 0) found.push_back(f);
  }
  return found;
}

/// A strip of quads whose end is joined to its begin upside down.
Triangles moebius_strip(int quads) {
  Triangles triangles(2 * quads, 3);
  for (int q = 0; q < quads; ++q) {
    const bool is_last = q + 1 == quads;
    const int a = 2 * q, b = a + 1;
    const int c = is_last ? 1 : a + 2, d = is_last ? 0 : a + 3;
    triangles.row(2 * q) << a, b, c;
    triangles.row(2 * q + 1) << b, d, c;
  }
  return triangles;
}

TEST(Orientation, NothingIsTurnedOnWhatIsRight) {
  for (const Mesh& mesh : {test::tetrahedron(), test::torus(7, 9), test::grid(5, 4)}) {
    EXPECT_TRUE(turned(mesh.triangles).empty());
    EXPECT_TRUE(find_orientation(mesh.triangles).twisted_pieces.empty());
  }
  EXPECT_TRUE(find_orientation(Triangles(0, 3)).is_turned.empty());
}

TEST(Orientation, FindsOneTriangleOfATorus) {
  Triangles triangles = test::torus(7, 9).triangles;
  turn(triangles, 31);
  EXPECT_EQ(turned(triangles), std::vector<int>{31});
  triangles = test::torus(7, 9).triangles;
  turn(triangles, 0);  // where the walk begins
  EXPECT_EQ(turned(triangles), std::vector<int>{0});
}

TEST(Orientation, FewerThanHalfAreTurnedAndOfTwoHalvesThatWithoutTheFirstTriangle) {
  const Triangles right = test::grid(9, 9).triangles;
  const auto half = static_cast<int>(right.rows() / 2);
  const auto with_first_turned = [&](int count) {
    Triangles triangles = right;
    for (int f = 0; f < count; ++f) turn(triangles, f);
    return turned(triangles);
  };
  EXPECT_EQ(with_first_turned(half - 1).size(), static_cast<std::size_t>(half - 1));
  EXPECT_EQ(with_first_turned(half - 1).front(), 0);
  EXPECT_EQ(with_first_turned(half + 1).size(), static_cast<std::size_t>(half - 1));
  EXPECT_EQ(with_first_turned(half + 1).back(), right.rows() - 1);
  EXPECT_EQ(with_first_turned(half).size(), static_cast<std::size_t>(half));
  EXPECT_EQ(with_first_turned(half).front(), half);
}

TEST(Orientation, EveryPieceHasItsOwnMajority) {
  const Mesh small = test::tetrahedron(), large = test::sphere(6, 8);
  Triangles triangles = test::joined(small, large).triangles;
  turn(triangles, 2);
  for (Eigen::Index f = small.triangles.rows(); f < triangles.rows(); ++f) {
    if (f != 20) turn(triangles, f);  // inside out as a whole: that is nobody's mistake
  }
  EXPECT_EQ(turned(triangles), (std::vector<int>{2, 20}));
}

TEST(Orientation, AMoebiusStripHasNone) {
  const Triangles strip = moebius_strip(5);
  const Orientation orientation = find_orientation(strip);
  EXPECT_EQ(orientation.twisted_pieces, std::vector<int>{0});
  EXPECT_TRUE(turned(strip).empty());
  Triangles beside = test::joined(test::grid(3, 3), {Positions(10, 3), strip}).triangles;
  turn(beside, 3);
  EXPECT_EQ(turned(beside), std::vector<int>{3});
  EXPECT_EQ(find_orientation(beside).twisted_pieces, std::vector<int>{8});
}

TEST(Orientation, DoesNotLookAcrossEdgesOfThreeTriangles) {
  Triangles triangles(3, 3);
  triangles << 0, 1, 2, 0, 1, 3, 0, 1, 4;
  EXPECT_TRUE(turned(triangles).empty());
}

}  // namespace
}  // namespace morphbake
