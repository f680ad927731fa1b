#include "morphbake/mesh/surface_edges.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "morphbake/mesh/measures.h"
#include "shapes/shapes.h"

namespace morphbake {
namespace {

/// Two triangles over the edge from the origin to (0, 1, 0); the right one is folded down from flat
/// by `degrees`.
Mesh hinge(double degrees) {
  const double angle = degrees * std::numbers::pi / 180;
  Mesh mesh{Positions(4, 3), Triangles(2, 3)};
  mesh.positions << 0, 0, 0, 0, 1, 0, -1, 0.5, 0, std::cos(angle), 0.5, -std::sin(angle);
  mesh.triangles << 0, 1, 2, 1, 0, 3;
  return mesh;
}

Eigen::VectorXd bends_of(const Mesh& mesh) {
  return bend_angles(mesh.positions, surface_edges(mesh.triangles));
}

TEST(SurfaceEdges, AreNoneOfNothing) {
  const SurfaceEdges edges = surface_edges(Triangles(0, 3));
  EXPECT_TRUE(edges.ends.empty());
  EXPECT_FALSE(edges.is_closed);
}

TEST(SurfaceEdges, HaveNoAngleAtBordersHeapsAndWhereTrianglesRunAlike) {
  Mesh mesh = hinge(20);
  EXPECT_EQ(bends_of(mesh).array().isNaN().count(), 4);
  Mesh alike = mesh;
  alike.triangles.row(1) << 0, 1, 3;
  EXPECT_TRUE(bends_of(alike).array().isNaN().all());
  mesh.positions.conservativeResize(5, 3);
  mesh.positions.row(4) << 0, 0.5, 1;
  mesh.triangles.conservativeResize(3, 3);
  mesh.triangles.row(2) << 0, 1, 4;
  EXPECT_TRUE(bends_of(mesh).array().isNaN().all());
}

TEST(SurfaceEdges, HaveNoAngleBesideATriangleWithoutArea) {
  Mesh mesh = hinge(20);
  mesh.positions.row(3) << 0, 0.5, 0;
  EXPECT_TRUE(bends_of(mesh).array().isNaN().all());
}

TEST(SurfaceEdges, BendByTheAngleOfTheHinge) {
  for (const double degrees : {-179.0, -90.0, -1e-3, 0.0, 45.0, 120.0, 179.0}) {
    EXPECT_NEAR(bends_of(hinge(degrees))(0), degrees, 1e-9) << degrees;
  }
}

TEST(SurfaceEdges, BendAlikeInAnySizeAndPlace) {
  Mesh mesh = hinge(30);
  for (const double scale : {1e-50, 1e50}) {
    Mesh scaled = mesh;
    scaled.positions *= scale;
    EXPECT_NEAR(bends_of(scaled)(0), 30, 1e-9) << scale;
  }
  mesh.positions.rowwise() += Eigen::RowVector3d(100, -200, 300);
  EXPECT_NEAR(bends_of(mesh)(0), 30, 1e-9);
}

TEST(SurfaceEdges, OfATetrahedronAreClosedAndConvex) {
  const Mesh mesh = test::tetrahedron();
  const SurfaceEdges edges = surface_edges(mesh.triangles);
  EXPECT_EQ(edges.ends.size(), 6U);
  EXPECT_TRUE(edges.is_closed);
  EXPECT_TRUE((bend_angles(mesh.positions, edges).array() > 0).all());
  EXPECT_FALSE(surface_edges(mesh.triangles.topRows(3)).is_closed);
  EXPECT_FALSE(surface_edges(hinge(0).triangles).is_closed);
}

TEST(SurfaceEdges, AreThoseOfEulersFormula) {
  const Mesh torus = test::torus(7, 9);
  EXPECT_EQ(surface_edges(torus.triangles).ends.size(), 3U * 7 * 9);
  const Mesh grid = test::grid(4, 3);
  EXPECT_EQ(surface_edges(grid.triangles).ends.size(), 12U + 12 - 1);
  EXPECT_NEAR(edge_lengths(grid.positions, surface_edges(grid.triangles)).minCoeff(), 1, 1e-12);
  EXPECT_NEAR(edge_lengths(grid.positions, surface_edges(grid.triangles)).maxCoeff(), std::sqrt(2),
              1e-12);
}

TEST(EnclosedVolume, IsThatOfTheBallAndChangesSignInsideOut) {
  Mesh ball = test::sphere(96, 128);
  const double volume = enclosed_volume(ball.positions, ball.triangles);
  EXPECT_NEAR(volume, 4 * std::numbers::pi / 3, 5e-3);
  ball.positions.rowwise() += Eigen::RowVector3d(1e4, 2e4, -3e4);
  EXPECT_NEAR(enclosed_volume(ball.positions, ball.triangles), volume, 1e-6);
  ball.triangles.col(0).swap(ball.triangles.col(1));
  EXPECT_NEAR(enclosed_volume(ball.positions, ball.triangles), -volume, 1e-6);
  EXPECT_EQ(enclosed_volume(Positions(0, 3), Triangles(0, 3)), 0);
}

}  // namespace
}  // namespace morphbake
