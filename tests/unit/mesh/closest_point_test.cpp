#include "morphbake/mesh/closest_point.h"

#include <gtest/gtest.h>

#include "shapes/shapes.h"

namespace morphbake {
namespace {

TEST(ClosestPoint, LiesOnTheSurface) {
  const Mesh mesh = test::grid(9, 9);
  const SurfacePoint inside = closest_point(mesh, {3.3, 4.1, 2});
  EXPECT_LT((position_of(mesh, inside) - Eigen::Vector3d(3.3, 4.1, 0)).norm(), 1e-12);
  const SurfacePoint corner = closest_point(mesh, {-5, -5, 1});
  EXPECT_LT(position_of(mesh, corner).norm(), 1e-12);
}

TEST(ClosestPoint, InATriangleWithoutAreaIsACorner) {
  Mesh mesh{Positions(3, 3), Triangles(1, 3)};
  mesh.positions << 1, 1, 1, 1, 1, 1, 1, 1, 1;
  mesh.triangles << 0, 1, 2;
  EXPECT_EQ(closest_point(mesh, {0, 0, 0}).barycentric, Eigen::Vector3d(1, 0, 0));
}

TEST(ClosestPoints, AreThoseOfEachRow) {
  const Mesh mesh = test::sphere(20, 30);
  Positions positions(2, 3);
  positions << 2, 0, 0, 0, 0, -3;
  const std::vector<SurfacePoint> points = closest_points(mesh, positions);
  ASSERT_EQ(points.size(), 2U);
  for (int i = 0; i < 2; ++i) {
    const SurfacePoint alone = closest_point(mesh, positions.row(i));
    EXPECT_EQ(points[static_cast<std::size_t>(i)].triangle, alone.triangle);
    EXPECT_EQ(points[static_cast<std::size_t>(i)].barycentric, alone.barycentric);
  }
}

}  // namespace
}  // namespace morphbake
