#include "morphbake/mesh/facing_point.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include "morphbake/mesh/closest_point.h"
#include "shapes/shapes.h"

namespace morphbake {
namespace {

TEST(FacingPoints, AreThoseOfTheNearSideOfWhatIsThin) {
  Mesh bar = test::bar(4);
  bar.positions.col(0) *= 1e-3;  // 0.0002 thin
  const FacingPoints search(bar);
  const Eigen::Vector3d at(-0.01, 0.5, 0.03);
  const SurfacePoint start = closest_point(bar, {0.01, 0.45, 0.0});
  for (const double side : {-1.0, 1.0}) {
    const SurfacePoint found = search.find(at, {side, 0, 0}, start);
    EXPECT_NEAR(position_of(bar, found).x(), side * 1e-4, 1e-12);
    EXPECT_NEAR(position_of(bar, found).y(), 0.5, 1e-12);
    EXPECT_NEAR(position_of(bar, found).z(), 0.03, 1e-12);
  }
}

TEST(FacingPoints, AreTheClosestOnesWhereThoseFaceTheSameWay) {
  const Mesh sphere = test::sphere(24, 32);
  const FacingPoints search(sphere);
  for (int v = 0; v < sphere.positions.rows(); ++v) {
    const Eigen::Vector3d normal = sphere.positions.row(v).transpose();
    const Eigen::Vector3d at = 1.05 * normal + Eigen::Vector3d(0.01, 0.02, -0.03);
    const SurfacePoint found = search.find(at, normal, {v % 7, {0.2, 0.3, 0.5}});
    EXPECT_NEAR((position_of(sphere, found) - at).norm(),
                (position_of(sphere, closest_point(sphere, at)) - at).norm(), 1e-12);
  }
}

TEST(FacingPoints, AreWhereTheSearchBeganWhenNoneIsCloser) {
  const Mesh grid = test::grid(4, 4);
  const FacingPoints search(grid);
  const SurfacePoint start{3, {0.2, 0.3, 0.5}};
  const SurfacePoint found = search.find({0.1, 0.1, 0}, {0, 0, -1}, start);
  EXPECT_EQ(found.triangle, start.triangle);
  EXPECT_EQ(found.barycentric, start.barycentric);
}

}  // namespace
}  // namespace morphbake
