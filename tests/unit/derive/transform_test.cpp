#include "morphbake/derive/transform.h"

#include <gtest/gtest.h>

#include "morphbake/diagnostics/problem.h"
#include "morphbake/mesh/measures.h"
#include "shapes/shapes.h"

namespace morphbake {
namespace {

Mesh shifted_sphere() {
  Mesh mesh = test::sphere(16, 20);
  mesh.positions = mesh.positions.rowwise() + Eigen::RowVector3d(2, 3, 4);
  return mesh;
}

TEST(Transform, RefusesAxesWithoutLength) {
  Transform turn;
  turn.degrees = 10;
  turn.axis.setZero();
  EXPECT_THROW(transformed(test::tetrahedron(), turn), BakeError);
  Transform stretch;
  stretch.scale_along = Eigen::Vector3d(0, 0, 0);
  EXPECT_THROW(transformed(test::tetrahedron(), stretch), BakeError);
}

TEST(Transform, OfNothingIsTheSource) {
  const Mesh mesh = shifted_sphere();
  EXPECT_EQ(transformed(mesh, {}), mesh.positions);
}

TEST(Transform, TranslatesExactly) {
  const Mesh mesh = shifted_sphere();
  Transform move;
  move.translation << 1, -2, 0.5;
  EXPECT_EQ(transformed(mesh, move), mesh.positions.rowwise() + Eigen::RowVector3d(1, -2, 0.5));
}

TEST(Transform, RotatesCounterClockwiseAboutAPoint) {
  Mesh mesh = test::tetrahedron();
  Transform turn;
  turn.axis << 0, 0, 7;
  turn.degrees = 90;
  turn.about = Eigen::Vector3d(1, 0, 0);
  Positions expected(4, 3);
  expected << 1, -1, 0, 1, 0, 0, 0, -1, 0, 1, -1, 1;
  EXPECT_LT(largest_distance(transformed(mesh, turn), expected), 1e-15);
}

TEST(Transform, RotatesAndScalesAboutTheCentreOfMass) {
  const Mesh mesh = shifted_sphere();
  Transform change;
  change.scale = 2;
  change.degrees = 77;
  change.axis << 1, 2, 3;
  change.translation << 0, 0, 5;
  const Positions result = transformed(mesh, change);
  const Eigen::RowVector3d centre(2, 3, 9);
  EXPECT_LT(((result.rowwise() - centre).rowwise().norm().array() - 2).abs().maxCoeff(), 1e-12);
  EXPECT_GT(
      largest_distance(result, (2 * mesh.positions).rowwise() + Eigen::RowVector3d(-2, -3, 1)),
      0.5);
}

TEST(Transform, ScalesAlongOneDirection) {
  Transform stretch;
  stretch.scale = 3;
  stretch.scale_along = Eigen::Vector3d(0, 5, 0);
  stretch.about = Eigen::Vector3d(9, 1, 9);
  Positions expected(4, 3);
  expected << 0, -2, 0, 1, -2, 0, 0, 1, 0, 0, -2, 1;
  EXPECT_LT(largest_distance(transformed(test::tetrahedron(), stretch), expected), 1e-14);
}

/// Scaling comes first: the stretched direction turns with the shape.
TEST(Transform, ScalesBeforeItRotates) {
  Transform change;
  change.scale = 3;
  change.scale_along = Eigen::Vector3d::UnitX();
  change.degrees = 90;
  change.axis = Eigen::Vector3d::UnitZ();
  change.about = Eigen::Vector3d::Zero();
  Positions expected(4, 3);
  expected << 0, 0, 0, 0, 3, 0, -1, 0, 0, 0, 0, 1;
  EXPECT_LT(largest_distance(transformed(test::tetrahedron(), change), expected), 1e-15);
}

}  // namespace
}  // namespace morphbake
