#include <gtest/gtest.h>

#include "morphbake/connectivity/morphable_mesh.h"
#include "morphbake/diagnostics/problem.h"
#include "shapes/shapes.h"
#include "shapes/sources.h"

namespace morphbake {
namespace {

using test::source_of;
using test::split_apart;

Mesh deformed(Mesh mesh, unsigned seed) {
  mesh.positions = test::bent(mesh.positions, 0.2, seed);
  return mesh;
}

TEST(ShareConnectivity, WeldsOnlyWhatLiesTogetherInEverySource) {
  // Two triangles that touch in the first source and are apart in the second.
  Mesh closed{Positions(6, 3), Triangles(2, 3)};
  closed.positions << 0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 0, 0, 0, 0, 0, 0, -1, 0;
  closed.triangles << 0, 1, 2, 3, 4, 5;
  Mesh open = closed;
  open.positions.bottomRows(3).col(1).array() -= 0.5;
  EXPECT_EQ(share_connectivity({source_of(closed, "a"), source_of(closed, "b")})
                .connectivity.vertex_count,
            4);
  EXPECT_EQ(
      share_connectivity({source_of(closed, "a"), source_of(open, "b")}).connectivity.vertex_count,
      6);
}

TEST(ShareConnectivity, SourcesMaySplitVerticesDifferently) {
  const Mesh sphere = test::sphere(8, 10);
  const Mesh other = deformed(sphere, 1);
  const MorphableMesh mesh =
      share_connectivity({source_of(split_apart(sphere), "a"), source_of(other, "b")});
  EXPECT_EQ(mesh.connectivity.vertex_count, sphere.positions.rows());
  EXPECT_EQ(mesh.vertex_of_render.size(), static_cast<std::size_t>(sphere.triangles.size()));
  for (int f = 0; f < sphere.triangles.rows(); ++f) {
    for (int k = 0; k < 3; ++k) {
      const int vertex = mesh.connectivity.triangles(f, k);
      EXPECT_EQ(mesh.geometries[0].row(vertex), sphere.positions.row(sphere.triangles(f, k)));
      EXPECT_EQ(mesh.geometries[1].row(vertex), other.positions.row(sphere.triangles(f, k)));
    }
  }
}

TEST(ShareConnectivity, LeavesDegenerateTrianglesOutAndTurnsWhatIsTurned) {
  Mesh mesh = test::sphere(8, 10);
  mesh.triangles.conservativeResize(mesh.triangles.rows() + 1, 3);
  mesh.triangles.bottomRows(1) << 3, 3, 4;
  std::swap(mesh.triangles(20, 1), mesh.triangles(20, 2));
  const MorphableMesh shared =
      share_connectivity({source_of(mesh, "a"), source_of(deformed(mesh, 2), "b")});
  EXPECT_EQ(shared.repairs.degenerate, 1);
  EXPECT_EQ(shared.repairs.duplicate, 0);
  EXPECT_EQ(shared.repairs.turned, 1);
  const Triangles right = test::sphere(8, 10).triangles;
  ASSERT_EQ(shared.connectivity.triangles.rows(), right.rows());
  for (Eigen::Index c = 0; c < right.size(); ++c) {
    EXPECT_EQ(shared.connectivity.triangles.data()[c],
              shared.vertex_of_render[static_cast<std::size_t>(
                  shared.render_of_corner[static_cast<std::size_t>(c)])]);
  }
  EXPECT_EQ(shared.render_of_corner[60], right(20, 0));
  EXPECT_EQ(shared.render_of_corner[61], right(20, 1));
  EXPECT_EQ(shared.triangle_of_file.back(), -1);
}

/// A grid whose triangle 0 is there a second time, with vertices of its own at the same places.
Mesh with_duplicate() {
  Mesh mesh = test::joined(test::grid(3, 3), {Positions(3, 3), Eigen::RowVector3i(0, 2, 1)});
  for (int k = 0; k < 3; ++k) mesh.positions.row(9 + k) = mesh.positions.row(mesh.triangles(0, k));
  return mesh;
}

TEST(ShareConnectivity, VerticesOfDuplicatesMoveWithTheSurface) {
  const Mesh mesh = with_duplicate();
  const MorphableMesh shared =
      share_connectivity({source_of(mesh, "a"), source_of(deformed(mesh, 2), "b")});
  EXPECT_EQ(shared.repairs.duplicate, 1);
  EXPECT_EQ(shared.connectivity.vertex_count, 9);
  EXPECT_EQ(shared.triangle_of_file.back(), 0);
  for (std::size_t k = 0; k < 3; ++k) {
    const auto twin = static_cast<std::size_t>(mesh.triangles(0, static_cast<int>(k)));
    EXPECT_EQ(shared.vertex_of_render[9 + k], shared.vertex_of_render[twin]);
  }
}

TEST(ShareConnectivity, ATriangleThatIsADuplicateInOneSourceOnlyIsKept) {
  const Mesh shut = with_duplicate();
  Mesh open = shut;
  open.positions.bottomRows(3).col(2).array() += 1;
  const MorphableMesh shared = share_connectivity({source_of(shut, "a"), source_of(open, "b")});
  EXPECT_FALSE(shared.repairs.any());
  EXPECT_EQ(shared.connectivity.vertex_count, 12);
}

}  // namespace
}  // namespace morphbake
