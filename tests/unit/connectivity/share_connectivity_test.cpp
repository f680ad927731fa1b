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

TEST(WeldRows, JoinsExactlyEqualPoints) {
  Positions rows(5, 3);
  rows << 0, 0, 0, 1, 0, 0, -0.0, 0, 0, 1, 0, 1e-300, 1, 0, 0;
  int count = 0;
  EXPECT_EQ(weld_rows(rows, count), (std::vector<int>{0, 1, 0, 2, 1}));
  EXPECT_EQ(count, 3);
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

TEST(ShareConnectivity, DropsDegenerateTriangles) {
  Mesh mesh = test::sphere(8, 10);
  mesh.triangles.conservativeResize(mesh.triangles.rows() + 1, 3);
  mesh.triangles.bottomRows(1) << 3, 3, 4;
  const MorphableMesh shared =
      share_connectivity({source_of(mesh, "a"), source_of(deformed(mesh, 2), "b")});
  EXPECT_EQ(shared.dropped_triangles, 1);
  EXPECT_EQ(shared.connectivity.triangles.rows(), mesh.triangles.rows() - 1);
  EXPECT_EQ(shared.render_of_corner.size(),
            static_cast<std::size_t>(shared.connectivity.triangles.size()));
}

}  // namespace
}  // namespace morphbake
