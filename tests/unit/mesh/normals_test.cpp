#include "morphbake/mesh/normals.h"

#include <gtest/gtest.h>

#include <numeric>

#include "shapes/shapes.h"

namespace morphbake {
namespace {

TEST(CarryNormal, TurnsAsItsReferenceTurns) {
  const Eigen::Vector3d from = Eigen::Vector3d(1, 2, 3).normalized();
  const Eigen::Vector3d to = Eigen::Vector3d(-2, 1, 0.5).normalized();
  EXPECT_LT((carry_normal(from, to, from) - to).norm(), 1e-15);
  EXPECT_LT((carry_normal(from, -from, from) + from).norm(), 1e-15);
  const Eigen::Vector3d own = Eigen::Vector3d(1, 2, 2.5).normalized();
  EXPECT_NEAR(carry_normal(from, to, own).dot(to), own.dot(from), 1e-15);
}

TEST(CornerGroupNormals, OfASphereAreItsPositions) {
  const Mesh mesh = test::sphere(40, 60);
  const std::vector<int> corners(mesh.triangles.data(),
                                 mesh.triangles.data() + mesh.triangles.size());
  const Normals normals = corner_group_normals(mesh.positions, mesh.triangles, corners,
                                               static_cast<int>(mesh.positions.rows()));
  EXPECT_LT((normals - mesh.positions).rowwise().norm().maxCoeff(), 0.01);
}

TEST(CornerGroupNormals, OfSeparateCornersAreFlat) {
  const Mesh mesh = test::tetrahedron();
  std::vector<int> corners(12);
  std::iota(corners.begin(), corners.end(), 0);
  const Normals normals = corner_group_normals(mesh.positions, mesh.triangles, corners, 12);
  EXPECT_LT((normals.row(0) - Eigen::RowVector3d(0, 0, -1)).norm(), 1e-15);
  EXPECT_LT((normals.row(9) - Eigen::RowVector3d(1, 1, 1).normalized()).norm(), 1e-15);
}

}  // namespace
}  // namespace morphbake
