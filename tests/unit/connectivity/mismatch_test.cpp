#include "morphbake/connectivity/mismatch.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "morphbake/connectivity/morphable_mesh.h"
#include "shapes/shapes.h"
#include "shapes/sources.h"

namespace morphbake {
namespace {

using test::source_of;
using test::split_apart;

Mesh deformed(Mesh mesh) {
  mesh.positions = test::bent(mesh.positions, 0.2, 3);
  return mesh;
}

/// Every triangle with vertices of its own, so that only positions join them.
SourceMesh split_source(const Mesh& mesh, const std::string& name) {
  return source_of(split_apart(mesh), name);
}

Mesh without(Mesh mesh, int first, int count) {
  const Eigen::Index rest = mesh.triangles.rows() - first - count;
  const Triangles after = mesh.triangles.bottomRows(rest);
  mesh.triangles.middleRows(first, rest) = after;
  mesh.triangles.conservativeResize(first + rest, 3);
  return mesh;
}

TEST(Mismatch, NoneHoweverVerticesAreSplit) {
  const Mesh torus = test::torus(7, 9);
  EXPECT_FALSE(find_mismatch(source_of(torus, "a"), split_source(deformed(torus), "b")).any());
  EXPECT_FALSE(find_mismatch(split_source(torus, "a"), source_of(deformed(torus), "b")).any());
}

TEST(Mismatch, FindsAPatchThatOneSourceLacks) {
  const Mesh torus = test::torus(12, 16);
  for (const int first : {0, 100, 250, static_cast<int>(torus.triangles.rows()) - 4}) {
    const SourceMesh whole = source_of(torus, "a");
    const SourceMesh holed = split_source(deformed(without(torus, first, 4)), "b");
    const TopologyMismatch lacking = find_mismatch(whole, holed);
    EXPECT_EQ(lacking.first_count - lacking.other_count, 4);
    for (int f = first; f < first + 4; ++f) {
      EXPECT_THAT(lacking.first_triangles, testing::Contains(f)) << first;
    }
    EXPECT_LE(lacking.first_triangles.size(), 10U) << first;  // the patch and what borders on it
    EXPECT_LE(lacking.other_triangles.size(), 6U) << first;
    const TopologyMismatch added = find_mismatch(holed, whole);
    EXPECT_EQ(added.other_triangles, lacking.first_triangles);
    EXPECT_EQ(added.first_triangles, lacking.other_triangles);
  }
}

TEST(Mismatch, TellsOfAPieceThatOnlyOneSourceHas) {
  const Mesh torus = test::torus(7, 9);
  const Mesh both = test::joined(torus, test::tetrahedron());
  const SourceMesh first = source_of(torus, "a"), other = source_of(both, "b");
  const TopologyMismatch mismatch = find_mismatch(first, other);
  EXPECT_TRUE(mismatch.first_triangles.empty());
  EXPECT_EQ(mismatch.other_triangles.size(), 4U);
  ASSERT_EQ(mismatch.places.size(), 1U);
  EXPECT_FALSE(mismatch.places[0].first);
  EXPECT_EQ(mismatch.places[0].other->triangle, torus.triangles.rows());
  const Problem problem = mismatch_problem(first, other, mismatch);
  EXPECT_EQ(problem.code, "connectivity.different-triangles");
  EXPECT_THAT(problem.message, testing::StartsWith("\"b\" has 130 triangles but \"a\" has 126; "
                                                   "first at (0.3333, 0.3333, 0) in \"b\" only"));
}

TEST(Mismatch, FindsAnEdgeThatRunsTheOtherWay) {
  const Mesh grid = test::grid(9, 9);
  Mesh other = deformed(grid);
  other.triangles.row(60) << 33, 34, 42;  // the quad's other diagonal
  other.triangles.row(61) << 34, 43, 42;
  ASSERT_EQ(grid.triangles.row(60), Eigen::RowVector3i(33, 34, 43));
  const SourceMesh a = source_of(grid, "a"), b = source_of(other, "b");
  const TopologyMismatch mismatch = find_mismatch(a, b);
  EXPECT_THAT(mismatch.first_triangles, testing::IsSupersetOf({60, 61}));
  EXPECT_LE(mismatch.first_triangles.size(), 6U);
  EXPECT_EQ(mismatch.torn_vertices, 0);
  ASSERT_FALSE(mismatch.places.empty());
  const Problem problem = mismatch_problem(a, b, mismatch);
  EXPECT_EQ(problem.code, "connectivity.different-topology");
  EXPECT_THAT(problem.message, testing::HasSubstr("triangles have other neighbours; first at ("));
  const double cell = 1.5;
  EXPECT_LT((mismatch.places[0].first->position - Eigen::RowVector3d(6.5, 3.5, 0)).norm(), cell);
}

TEST(Mismatch, FindsASeamThatIsNotWelded) {
  const Mesh grid = test::grid(5, 5);
  Mesh open = grid;  // cut along the column x = 2, above its end at the bottom
  open.positions.conservativeResize(29, 3);
  for (int r = 1; r < 5; ++r) {
    open.positions.row(24 + r) = grid.positions.row(5 * r + 2) + Eigen::RowVector3d(0.1, 0, 0);
  }
  for (Eigen::Index f = 0; f < open.triangles.rows(); ++f) {
    const bool is_right = f / 2 % 4 >= 2;
    for (int k = 0; k < 3; ++k) {
      int& v = open.triangles(f, k);
      if (is_right && v % 5 == 2 && v > 4) v = 24 + v / 5;
    }
  }
  const TopologyMismatch mismatch = find_mismatch(source_of(grid, "a"), source_of(open, "b"));
  EXPECT_EQ(mismatch.other_neighbours, 8);  // on both sides of four edges
  EXPECT_GT(mismatch.torn_vertices, 0);
  EXPECT_EQ(mismatch.places[0].first->position(0), 2);
  EXPECT_EQ(mismatch.places[0].other->position(0), 2);
  EXPECT_THROW(share_connectivity({source_of(grid, "a"), source_of(open, "b")}), BakeError);
}

TEST(Mismatch, FindsAVertexThatIsTornWhereNoEdgeIs) {
  Mesh pinched{Positions(5, 3), Triangles(2, 3)};
  pinched.positions << 0, 0, 0, 1, 0, 0, 0, 1, 0, -1, 0, 0, 0, -1, 0;
  pinched.triangles << 0, 1, 2, 0, 3, 4;
  Mesh torn = split_apart(pinched);
  torn.positions.row(3) << -0.1, -0.1, 0;
  const TopologyMismatch mismatch = find_mismatch(source_of(pinched, "a"), source_of(torn, "b"));
  EXPECT_EQ(mismatch.other_neighbours, 0);
  EXPECT_EQ(mismatch.torn_vertices, 1);
  EXPECT_EQ(mismatch.first_triangles, (std::vector<int>{0, 1}));
  ASSERT_EQ(mismatch.places.size(), 1U);
  EXPECT_TRUE(mismatch.places[0].first->position.isZero());
  EXPECT_TRUE(find_mismatch(source_of(torn, "b"), source_of(pinched, "a")).any());
}

TEST(Mismatch, OfMeshesThatHaveNothingInCommonIsFound) {
  const Mesh sphere = test::sphere(9, 7), torus = test::torus(8, 7);
  ASSERT_EQ(sphere.triangles.rows(), torus.triangles.rows());
  EXPECT_TRUE(find_mismatch(source_of(sphere, "a"), source_of(torus, "b")).any());
  EXPECT_TRUE(find_mismatch(source_of(sphere, "a"), source_of(test::tetrahedron(), "b")).any());
  EXPECT_TRUE(find_mismatch(source_of(sphere, "a"), source_of({}, "b")).any());
}

}  // namespace
}  // namespace morphbake
