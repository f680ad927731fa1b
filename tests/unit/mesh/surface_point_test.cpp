#include "morphbake/mesh/surface_point.h"

#include <gtest/gtest.h>

#include "morphbake/mesh/closest_point.h"
#include "shapes/shapes.h"

namespace morphbake {
namespace {

TEST(SurfacePoint, PlaneCoordinatesInvertPositions) {
  Eigen::Matrix3d corners;
  corners << 0, 0, 1, 2, 0, 1, 0, 3, 2;
  for (const Eigen::Vector3d& expected :
       {Eigen::Vector3d(0.2, 0.3, 0.5), Eigen::Vector3d(-0.5, 0.75, 0.75),
        Eigen::Vector3d(0, 0, 1)}) {
    const Eigen::Vector3d inside = corners.transpose() * expected;
    const Eigen::Vector3d normal(0, -2, 6);
    EXPECT_LT((plane_coordinates(corners, inside + 0.1 * normal) - expected).norm(), 1e-14);
  }
}

TEST(SurfacePoint, NearestCornerIsThatOfTheLargestShare) {
  const Mesh mesh = test::grid(3, 3);
  EXPECT_EQ(nearest_corner(mesh, closest_point(mesh, {0.9, 0.8, 5})), 4);
  EXPECT_EQ(nearest_corner(mesh, closest_point(mesh, {1.2, 0.1, 0})), 1);
}

TEST(SurfacePoint, VertexPointsLieAtTheirVertices) {
  const Mesh mesh = test::sphere(5, 6);
  const std::vector<int> vertices = {7, 0, 3, 3};
  const std::vector<SurfacePoint> points = vertex_points(mesh, vertices);
  ASSERT_EQ(points.size(), vertices.size());
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    EXPECT_EQ(position_of(mesh, points[i]).transpose(), mesh.positions.row(vertices[i]));
  }
}

}  // namespace
}  // namespace morphbake
