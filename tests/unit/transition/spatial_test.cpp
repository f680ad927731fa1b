#include "morphbake/transition/spatial.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "morphbake/diagnostics/problem.h"
#include "shapes/shapes.h"

namespace morphbake {
namespace {

using Eigen::Vector3d;

template <typename Value>
Animated<Value> constant(const Value& value) {
  return {{}, {value}};
}

Positions points() {
  Positions p(6, 3);
  p << 0, 0, 0, 1, 0, 0, 0, 2, 0, 0, 0, -3, 1, 1, 1, -0.5, 0.25, 0.75;
  return p;
}

Eigen::VectorXd distance_to(const decltype(SpatialRegion::shape)& shape, double time = 0) {
  return signed_distance({shape, constant(0.0), {}}, points(), time);
}

TEST(SpatialShapes, HaveTheirClosedForms) {
  const Positions p = points();
  const Eigen::VectorXd half = distance_to(HalfSpace{constant(Vector3d(2, 0, 0)), constant(0.25)});
  const Eigen::VectorXd slab =
      distance_to(Slab{constant(Vector3d(0, 1, 0)), constant(0.5), constant(1.0)});
  const Eigen::VectorXd ball = distance_to(SphereShape{constant(Vector3d(1, 0, 0)), constant(0.5)});
  const Eigen::VectorXd tube = distance_to(
      Cylinder{constant(Vector3d(0, 0, 1)), constant(Vector3d(0, 0, 1)), constant(0.5), {}});
  const Eigen::VectorXd formula = distance_to(Expression{"x + y * y - 2 * t"}, 0.5);
  for (Eigen::Index i = 0; i < p.rows(); ++i) {
    EXPECT_DOUBLE_EQ(half(i), p(i, 0) - 0.25);
    EXPECT_DOUBLE_EQ(slab(i), std::abs(p(i, 1) - 0.5) - 0.5);
    EXPECT_DOUBLE_EQ(ball(i), (p.row(i) - Eigen::RowVector3d(1, 0, 0)).norm() - 0.5);
    EXPECT_NEAR(tube(i), std::hypot(p(i, 0), p(i, 1)) - 0.5, 1e-15);
    EXPECT_DOUBLE_EQ(formula(i), p(i, 0) + p(i, 1) * p(i, 1) - 1);
  }
}

TEST(SpatialShapes, ABoxIsExactInsideAndOut) {
  const Eigen::VectorXd box =
      distance_to(Box{constant(Vector3d(0, 0, 0)), constant(Vector3d(1, 2, 4))});
  EXPECT_DOUBLE_EQ(box(0), -0.5);  // the nearest face is at x = 0.5
  EXPECT_DOUBLE_EQ(box(1), 0.5);   // straight out of a face
  EXPECT_DOUBLE_EQ(box(2), 1);     // y = 2 over y = 1
  EXPECT_DOUBLE_EQ(box(4), 0.5);   // on the plane y = 1
  const Eigen::VectorXd ended = distance_to(Cylinder{
      constant(Vector3d(0, 0, 0)), constant(Vector3d(0, 0, 3)), constant(1.0), constant(2.0)});
  EXPECT_DOUBLE_EQ(ended(3), 2);                   // below the end
  EXPECT_DOUBLE_EQ(ended(4), std::sqrt(2.0) - 1);  // beside, at the height of the end
  EXPECT_DOUBLE_EQ(ended(0), -1);
}

TEST(SpatialDistance, ASoftBorderLiesHalfInside) {
  const auto p = std::make_shared<const Positions>(points());
  const SpatialRegion region{
      HalfSpace{constant(Vector3d(1, 0, 0)), constant(0.0)}, constant(4.0), {}};
  const Eigen::VectorXd d = spatial_distance({region, {p}}, 0);
  EXPECT_DOUBLE_EQ(d(0), 0.5);
  EXPECT_DOUBLE_EQ(d(1), 0.75);
  EXPECT_DOUBLE_EQ(d(5), 0.375);
}

TEST(SpatialDistance, AveragesOverSources) {
  const auto a = std::make_shared<const Positions>(Positions::Constant(2, 3, -1));
  const auto b = std::make_shared<const Positions>(Positions::Constant(2, 3, 1));
  const SpatialRegion region{
      HalfSpace{constant(Vector3d(1, 0, 0)), constant(0.0)}, constant(0.0), {}};
  EXPECT_DOUBLE_EQ(spatial_distance({region, {a, b}}, 0)(0), 0.5);
}

TEST(SpatialDistance, FollowsItsKeys) {
  SpatialRegion region{
      HalfSpace{constant(Vector3d(1, 0, 0)), {{1, 3}, {-1, 1}}}, constant(0.0), {}};
  EXPECT_TRUE(moves_with_time(region));
  EXPECT_DOUBLE_EQ(signed_distance(region, points(), 0)(0), 1);
  EXPECT_DOUBLE_EQ(signed_distance(region, points(), 2)(0), 0);
  EXPECT_DOUBLE_EQ(signed_distance(region, points(), 2.5)(0), -0.5);
  EXPECT_DOUBLE_EQ(signed_distance(region, points(), 9)(0), -1);
  region.shape = Expression{"x + 0.5"};
  EXPECT_FALSE(moves_with_time(region));
  region.shape = Expression{"x + t"};
  EXPECT_TRUE(moves_with_time(region));
}

std::string message_of(const std::string& formula) {
  try {
    distance_to(Expression{formula});
  } catch (const BakeError& error) {
    return error.what();
  }
  return "";
}

TEST(Expressions, TellWhatIsWrong) {
  EXPECT_EQ(expression_error("x * sin(y) - t"), "");
  for (const char* bad : {"", "x +", "x * (y", "foo(x)", "w", "x, y", "sin(x, y)", "1 2"}) {
    EXPECT_NE(expression_error(bad), "") << bad;
  }
  EXPECT_THAT(message_of("1 / x"), testing::HasSubstr("is inf at x = 0, y = 0"));
  EXPECT_THAT(message_of("sqrt(x - 10)"), testing::HasSubstr("nan at x = 0"));
}

TEST(CentredCoordinates, StandAtTheCentreOfTheSurface) {
  // A grid with many small cells on one side: the centre of area is the middle all the same.
  Mesh mesh = test::grid(21, 5);
  for (Eigen::Index v = 0; v < mesh.positions.rows(); ++v) {
    mesh.positions(v, 0) = std::pow(mesh.positions(v, 0) / 20, 2) * 20 + 7;
  }
  const Positions centred = centred_coordinates(mesh, 2);
  EXPECT_NEAR(centred.col(0).minCoeff(), -5, 1e-12);
  EXPECT_NEAR(centred.col(0).maxCoeff(), 5, 1e-12);
  EXPECT_NEAR(centred.col(1).maxCoeff(), 1, 1e-12);
}

}  // namespace
}  // namespace morphbake
