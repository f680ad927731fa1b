#include "morphbake/derive/mirror.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <string>

#include "morphbake/diagnostics/problem.h"
#include "morphbake/mesh/measures.h"
#include "shapes/shapes.h"

namespace morphbake {
namespace {

Problem problem_of(const Mesh& mesh, const MirrorPlane& plane) {
  try {
    mirrored(mesh, plane);
  } catch (const BakeError& error) {
    return error.problems().front();
  }
  return {};
}

/// A bump on the torus around (1.4, 0, 0), to +Y: the right half of a smile.
Positions smile(const Positions& face, double side) {
  Positions positions = face;
  for (auto row : positions.rowwise()) {
    const double distance = (row - Eigen::RowVector3d(1.4 * side, 0, 0)).norm();
    if (distance < 0.8) row.y() += 0.5 * (0.8 - distance);
  }
  return positions;
}

TEST(Mirror, RefusesAShapeWithoutThatPlane) {
  Mesh mesh = test::torus(24, 16);
  mesh.positions.row(5) += Eigen::RowVector3d(0, 1, 0);
  const Problem problem = problem_of(mesh, {});
  EXPECT_EQ(problem.code, "derive.not-symmetric");
  EXPECT_NE(problem.message.find("vertex 5 lies"), std::string::npos) << problem.message;
  const Mesh torus = test::torus(24, 16);
  EXPECT_EQ(problem_of(torus, {Eigen::Vector3d::UnitX(), 0.5}).code, "derive.not-symmetric");
  EXPECT_EQ(problem_of(torus, {Eigen::Vector3d::UnitX(), 1e200}).code, "derive.not-symmetric");
}

TEST(Mirror, RefusesAPlaneWithoutNormal) {
  EXPECT_EQ(problem_of(test::torus(24, 16), {Eigen::Vector3d::Zero(), 0}).code,
            "derive.no-direction");
}

TEST(Mirror, LeavesASymmetricShapeAsItIs) {
  const Mesh mesh = test::torus(24, 16);
  EXPECT_LT(largest_distance(mirrored(mesh, {}), mesh.positions), 1e-14);
}

TEST(Mirror, TurnsALeftSmileIntoARightOneExactly) {
  const Mesh face = test::torus(24, 16);
  const Mesh left{smile(face.positions, -1), face.triangles};
  const Positions right = mirrored(left, {}, face.positions);
  EXPECT_LT(largest_distance(right, smile(face.positions, 1)), 1e-14);
  EXPECT_GT(largest_distance(right, left.positions), 0.3);
  EXPECT_EQ(mirrored({right, face.triangles}, {}, face.positions), left.positions);
}

TEST(Mirror, TakesAPlaneAnywhere) {
  Mesh face = test::torus(24, 16);
  const Eigen::Affine3d turn = Eigen::Translation3d(3, 1, -2) *
                               Eigen::AngleAxisd(0.8, Eigen::Vector3d(1, 2, 3).normalized());
  const auto moved = [&](const Positions& positions) {
    return Positions((positions * turn.linear().transpose()).rowwise() +
                     turn.translation().transpose());
  };
  const Eigen::Vector3d normal = turn.linear() * Eigen::Vector3d(5, 0, 0);
  const Mesh left{moved(smile(face.positions, -1)), face.triangles};
  const Positions right =
      mirrored(left, {normal, normal.dot(turn.translation())}, moved(face.positions));
  EXPECT_LT(largest_distance(right, moved(smile(face.positions, 1))), 1e-13);
}

TEST(Mirror, InterpolatesWhereVerticesDoNotPairUp) {
  const Mesh mesh = test::sphere(40, 40);  // its own image across any plane but for its facets
  const Positions result = mirrored(mesh, {Eigen::Vector3d(1, 0.3, -0.2), 0});
  EXPECT_LT(largest_distance(result, mesh.positions), 0.02);
  EXPECT_LT((result.rowwise().norm().array() - 1).abs().maxCoeff(), 0.01);
}

/// Two lips that touch along y = 0 where the reference is closed.
TEST(Mirror, KeepsTheLipsOfAClosedMouthApart) {
  Mesh mesh = test::joined(test::grid(9, 4), test::grid(9, 4));
  mesh.positions.col(0).array() -= 4;
  mesh.positions.bottomRows(36).col(1) *= -1;
  const Positions closed = mesh.positions;
  mesh.positions.row(0).y() += 0.5;    // upper lip's left end
  mesh.positions.row(36).y() -= 0.25;  // lower lip's
  const Positions result = mirrored(mesh, {}, closed);
  Positions expected = closed;
  expected.row(8).y() += 0.5;
  expected.row(44).y() -= 0.25;
  EXPECT_EQ(result, expected);
}

TEST(Mirror, GivesNumbersOnDegenerateMeshes) {
  Mesh mesh = test::torus(24, 16);
  mesh.positions.setConstant(2);
  EXPECT_TRUE(mirrored(mesh, {}).allFinite());
  mesh = test::torus(24, 16);
  mesh.positions.col(1).setZero();
  mesh.positions.col(2).setZero();  // a line, mirrored at its middle
  EXPECT_LT(largest_distance(mirrored(mesh, {}), mesh.positions), 1e-14);
}

}  // namespace
}  // namespace morphbake
