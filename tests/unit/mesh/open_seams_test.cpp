#include "morphbake/mesh/open_seams.h"

#include <gtest/gtest.h>

#include "shapes/shapes.h"

namespace morphbake {
namespace {

/// Two grids of 3 by 3 vertices side by side, the second one `gap` away.
Mesh two_sheets(double gap) {
  Mesh right = test::grid(3, 3);
  right.positions.col(0).array() += 2 + gap;
  return test::joined(test::grid(3, 3), right);
}

std::vector<Eigen::Vector2i> seams_of(const Mesh& mesh) {
  return find_open_seams(mesh.triangles, {mesh.positions});
}

TEST(OpenSeams, AreNoneOfClosedSurfacesAndLonelyBorders) {
  EXPECT_TRUE(seams_of(test::torus(7, 9)).empty());
  EXPECT_TRUE(seams_of(test::grid(5, 4)).empty());
  EXPECT_TRUE(seams_of(two_sheets(1e-4)).empty());
  EXPECT_TRUE(seams_of({Positions(0, 3), Triangles(0, 3)}).empty());
}

TEST(OpenSeams, AreEdgesOfBothSides) {
  const std::vector<Eigen::Vector2i> seams = seams_of(two_sheets(1e-7));
  ASSERT_EQ(seams.size(), 4U);
  EXPECT_EQ(seams[0], Eigen::Vector2i(2, 5));
  EXPECT_EQ(seams[3], Eigen::Vector2i(12, 15));
}

TEST(OpenSeams, MayEndAtAPointThatIsJoined) {
  Mesh mesh = two_sheets(1e-7);
  mesh.triangles = (mesh.triangles.array() == 9).select(2, mesh.triangles);
  EXPECT_EQ(seams_of(mesh).size(), 4U);
}

TEST(OpenSeams, AreNoneWhereASourceOpensThem) {
  const Mesh shut = two_sheets(1e-7), open = two_sheets(0.5);
  EXPECT_EQ(find_open_seams(shut.triangles, {shut.positions, shut.positions}).size(), 4U);
  EXPECT_TRUE(find_open_seams(shut.triangles, {shut.positions, open.positions}).empty());
}

TEST(OpenSeams, AreNotLookedForInPartsTooSmallToTell) {
  Mesh mesh = two_sheets(0.5);
  mesh.positions *= 1e-7;
  mesh.positions.row(17) << 1, 1, 1;
  EXPECT_TRUE(seams_of(mesh).empty());
}

}  // namespace
}  // namespace morphbake
