#include "morphbake/mesh/centre_of_mass.h"

#include <gtest/gtest.h>

#include "shapes/shapes.h"

namespace morphbake {
namespace {

TEST(CentreOfMass, IsOfTheSurface) {
  Mesh sphere = test::sphere(20, 30);
  sphere.positions.rowwise() += Eigen::RowVector3d(2, 3, 4);
  EXPECT_LT((centre_of_mass(sphere.positions, sphere.triangles) - Eigen::Vector3d(2, 3, 4)).norm(),
            1e-12);
  // The half of a grid that is cut finer weighs no more.
  Mesh grid = test::grid(11, 2);
  for (int v = 0; v < 22; ++v) {
    double& x = grid.positions(v, 0);
    x = x < 9.5 ? x / 9 : 2;
  }
  EXPECT_LT((centre_of_mass(grid.positions, grid.triangles) - Eigen::Vector3d(1, 0.5, 0)).norm(),
            1e-12);
  grid.positions.setConstant(3);
  EXPECT_LT((centre_of_mass(grid.positions, grid.triangles) - Eigen::Vector3d(3, 3, 3)).norm(),
            1e-14);
  EXPECT_EQ(centre_of_mass(Positions(0, 3), Triangles(0, 3)), Eigen::Vector3d::Zero());
}

}  // namespace
}  // namespace morphbake
