#include "morphbake/transition/surface_distance.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "morphbake/mesh/closest_point.h"
#include "shapes/shapes.h"

namespace morphbake {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

Eigen::VectorXd geodesic_distances(const Mesh& mesh, const PointSet& from) {
  return GeodesicDistances(mesh, {from}).from_set(0);
}

TEST(EdgeDistances, FollowTheEdges) {
  const Mesh mesh = test::grid(9, 9);  // diagonals run from lower left to upper right
  const Eigen::VectorXd r = edge_distances(mesh, {closest_point(mesh, {4, 4, 0})});
  EXPECT_NEAR(r(4 * 9 + 4), 0, 1e-12);
  EXPECT_NEAR(r(4 * 9 + 7), 3, 1e-12);
  EXPECT_NEAR(r(6 * 9 + 6), 2 * std::sqrt(2.0), 1e-12);
  EXPECT_NEAR(r(6 * 9 + 2), 4, 1e-12);  // against the diagonals
}

TEST(EdgeDistances, StartStraightFromAPointInsideATriangle) {
  const Mesh mesh = test::grid(3, 3);
  const Eigen::VectorXd r = edge_distances(mesh, {closest_point(mesh, {0.6, 0.3, 0})});
  EXPECT_NEAR(r(0), std::hypot(0.6, 0.3), 1e-12);
  EXPECT_NEAR(r(1), std::hypot(0.4, 0.3), 1e-12);
}

TEST(EdgeDistances, OtherComponentsAreUnreachable) {
  const Mesh mesh = test::joined(test::grid(3, 3), test::sphere(5, 6));
  EXPECT_EQ(edge_distances(mesh, {{0, {1, 0, 0}}})(20), kInfinity);
}

/// Largest error against the straight distance in the plane, relative to the grid's width of 40.
double plane_error(const Eigen::Vector3d& centre) {
  const Mesh mesh = test::grid(41, 41);
  const Eigen::VectorXd r = geodesic_distances(mesh, {closest_point(mesh, centre)});
  const Eigen::VectorXd exact = (mesh.positions.rowwise() - centre.transpose()).rowwise().norm();
  return (r - exact).cwiseAbs().maxCoeff() / 40;
}

// The error that surface_distance.h documents for the heat method: at most 4 % of the distance
// across.
TEST(GeodesicDistances, OnAPlane) {
  EXPECT_LT(plane_error({20, 20, 0}), 0.04);
  EXPECT_LT(plane_error({17.3, 22.6, 0}), 0.04);  // inside a triangle
  EXPECT_LT(plane_error({17.5, 22, 0}), 0.04);    // on an edge
  EXPECT_LT(plane_error({17.5, 0, 0}), 0.04);     // on the boundary
}

TEST(GeodesicDistances, OnASphereAreArcs) {
  const Mesh mesh = test::sphere(60, 120);
  const Eigen::Vector3d centre = Eigen::Vector3d(0.3, 0.5, 0.8).normalized();
  const Eigen::VectorXd r = geodesic_distances(mesh, {closest_point(mesh, centre)});
  for (Eigen::Index v = 0; v < r.size(); ++v) {
    const double arc = std::acos(std::clamp(mesh.positions.row(v).dot(centre), -1.0, 1.0));
    EXPECT_NEAR(r(v), arc, 0.04 * M_PI);
  }
}

TEST(GeodesicDistances, TheNearestOfSeveralPointsCounts) {
  const Mesh mesh = test::grid(41, 41);
  const PointSet both = {closest_point(mesh, {5, 20, 0}), closest_point(mesh, {35, 20, 0})};
  const Eigen::VectorXd r = geodesic_distances(mesh, both);
  for (Eigen::Index v = 0; v < r.size(); ++v) {
    const Eigen::RowVector3d p = mesh.positions.row(v);
    const double exact = std::min((p - Eigen::RowVector3d(5, 20, 0)).norm(),
                                  (p - Eigen::RowVector3d(35, 20, 0)).norm());
    EXPECT_NEAR(r(v), exact, 0.04 * 40);
  }
}

TEST(GeodesicDistances, SetsMayShareATriangle) {
  const Mesh mesh = test::grid(21, 21);
  const SurfacePoint a = closest_point(mesh, {10.2, 10.6, 0});
  const SurfacePoint b = closest_point(mesh, {10.4, 10.8, 0});
  ASSERT_EQ(a.triangle, b.triangle);
  GeodesicDistances distances(mesh, {{a}, {b}});
  EXPECT_LT(std::abs(distances.from_set(0)(0) - std::hypot(10.2, 10.6)), 0.8);
  EXPECT_LT(std::abs(distances.from_set(1)(0) - std::hypot(10.4, 10.8)), 0.8);
}

TEST(GeodesicDistances, VerticesMayBeAskedLater) {
  const Mesh mesh = test::joined(test::sphere(12, 16), test::grid(41, 41));
  const auto grid = static_cast<int>(mesh.positions.rows()) - 41 * 41;
  GeodesicDistances distances(mesh, {{closest_point(mesh, {10.2, 30.6, 0})}});
  const Eigen::VectorXd r = distances.from_vertices({grid + 20 * 41 + 10, grid + 20 * 41 + 30});
  EXPECT_EQ(r(0), kInfinity);
  for (Eigen::Index v = grid; v < r.size(); ++v) {
    const Eigen::RowVector3d p = mesh.positions.row(v);
    const double exact = std::min((p - Eigen::RowVector3d(10, 20, 0)).norm(),
                                  (p - Eigen::RowVector3d(30, 20, 0)).norm());
    EXPECT_NEAR(r(v), exact, 0.04 * 40);
  }
}

TEST(GeodesicDistances, SeveralPointsInOneTriangleCount) {
  const Mesh mesh = test::grid(21, 21);
  const PointSet set = {closest_point(mesh, {10.05, 10.2, 0}), closest_point(mesh, {10.7, 10.9, 0}),
                        closest_point(mesh, {10.1, 10.9, 0})};
  ASSERT_EQ(set[0].triangle, set[1].triangle);
  ASSERT_EQ(set[0].triangle, set[2].triangle);
  const Eigen::VectorXd r = geodesic_distances(mesh, set);
  EXPECT_NEAR(r(10 * 21 + 10), std::hypot(0.05, 0.2), 0.2);
  EXPECT_NEAR(r(11 * 21 + 11), std::hypot(0.3, 0.1), 0.2);
  EXPECT_NEAR(r(11 * 21 + 10), std::hypot(0.1, 0.1), 0.2);
}

TEST(HopDistances, CountEdges) {
  const Mesh mesh = test::joined(test::grid(5, 5), test::grid(2, 2));
  const Eigen::VectorXd hops = hop_distances(mesh, {0});
  EXPECT_EQ(hops(0), 0);
  EXPECT_EQ(hops(4), 4);
  EXPECT_EQ(hops(24), 4);  // the diagonals lead there
  EXPECT_EQ(hops(25), kInfinity);
}

TEST(GeodesicDistances, OtherComponentsAreUnreachable) {
  const Mesh mesh = test::joined(test::grid(9, 9), test::sphere(8, 10));
  const Eigen::VectorXd r = geodesic_distances(mesh, {closest_point(mesh, {4, 4, 0})});
  EXPECT_TRUE(r.head(81).allFinite());
  EXPECT_EQ(r(81), kInfinity);
}

}  // namespace
}  // namespace morphbake
