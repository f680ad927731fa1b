#include "morphbake/transition/regions.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <random>

#include "morphbake/diagnostics/problem.h"
#include "morphbake/mesh/closest_point.h"
#include "morphbake/transition/rings.h"
#include "shapes/shapes.h"

namespace morphbake {
namespace {

using Eigen::Vector3d;

/// A recipe over `mesh` and a copy of it, with regions and lengths in scene units.
Recipe recipe_with(std::vector<RegionOfInterest> regions) {
  Recipe recipe;
  recipe.units = Units::Scene;
  recipe.sources.resize(2);
  recipe.timeline.start = Shares{{1}, {0}};
  recipe.regions = std::move(regions);
  return recipe;
}

MorphableMesh twins(const Mesh& mesh) {
  return test::morphable(mesh.triangles, {mesh.positions, mesh.positions});
}

/// d of the last region.
Eigen::VectorXd last_distance(const Mesh& mesh, std::vector<RegionOfInterest> regions,
                              const RegionMoment& moment = {}) {
  const auto last = static_cast<int>(regions.size()) - 1;
  const RegionFields fields = region_fields(twins(mesh), recipe_with(std::move(regions)));
  return distance_at(fields, last, moment);
}

BallRegion ball(const Vector3d& centre, double inner, double outer) {
  return {0, centre, inner, outer, DistanceMeasure::Geodesic};
}

std::vector<Place> circle(double height, int points) {
  std::vector<Place> places;
  for (int k = 0; k < points; ++k) {
    const double angle = 2 * M_PI * k / points, r = std::sqrt(1 - height * height);
    places.emplace_back(Vector3d(r * std::cos(angle), height, r * std::sin(angle)));
  }
  return places;
}

std::string problem_of(const Mesh& mesh, std::vector<RegionOfInterest> regions) {
  try {
    last_distance(mesh, std::move(regions));
  } catch (const BakeError& error) {
    return error.what();
  }
  return "";
}

TEST(Rings, OnASphereAreParallels) {
  const Mesh mesh = test::sphere(60, 96);
  const Eigen::VectorXd d =
      last_distance(mesh, {{"cap", RingsRegion{0, circle(0.6, 8), circle(0, 8)}}});
  for (Eigen::Index v = 0; v < d.size(); ++v) {
    const double y = mesh.positions(v, 1);
    if (y > 0.65 || y < -0.05) {
      EXPECT_EQ(d(v), y < 0 ? 1 : 0) << y;
      continue;
    }
    // Arcs from either parallel; the loops stray from them by an edge, the heat method errs by 4 %.
    const double from_inner = std::acos(0.6), whole = M_PI / 2 - from_inner;
    EXPECT_NEAR(d(v), std::clamp((std::acos(y) - from_inner) / whole, 0.0, 1.0), 0.12) << y;
  }
}

TEST(Rings, AreContinuousAcrossTheirLoops) {
  const Mesh mesh = test::sphere(60, 96);
  const Eigen::VectorXd d =
      last_distance(mesh, {{"cap", RingsRegion{0, circle(0.6, 8), circle(-0.3, 8)}}});
  double largest = 0;  // step over an edge
  for (Eigen::Index f = 0; f < mesh.triangles.rows(); ++f) {
    for (int k = 0; k < 3; ++k) {
      largest =
          std::max(largest, std::abs(d(mesh.triangles(f, k)) - d(mesh.triangles(f, (k + 1) % 3))));
    }
  }
  EXPECT_LT(largest, 0.1);  // 18 edges from loop to loop
}

TEST(Rings, TellWhatIsWrongWithALoop) {
  const Mesh mesh = test::sphere(40, 64);
  EXPECT_THAT(problem_of(mesh, {{"r", RingsRegion{0, circle(0, 8), circle(0, 8)}}}),
              testing::HasSubstr("meets the inner loop"));
  std::vector<Place> crossed = circle(0.3, 4);
  std::swap(crossed[1], crossed[2]);
  EXPECT_THAT(problem_of(mesh, {{"r", RingsRegion{0, crossed, circle(-0.5, 8)}}}),
              testing::HasSubstr("#/regions/r/rings/inner: error: the inner loop is no ring: it "
                                 "meets itself"));
  EXPECT_THAT(problem_of(mesh, {{"r", RingsRegion{0, circle(0.9999, 3), circle(-0.5, 8)}}}),
              testing::HasSubstr("a loop needs three"));
  // Around a torus' tube a loop cuts nothing off.
  const Mesh torus = test::torus(48, 24);
  std::vector<Place> around, other;
  for (int k = 0; k < 6; ++k) {
    const double angle = 2 * M_PI * k / 6;
    around.emplace_back(Vector3d(1 + 0.4 * std::cos(angle), 0.4 * std::sin(angle), 0));
    other.emplace_back(Vector3d(-1 - 0.4 * std::cos(angle), 0.4 * std::sin(angle), 0));
  }
  EXPECT_THAT(problem_of(torus, {{"r", RingsRegion{0, around, other}}}),
              testing::HasSubstr("does not cut anything off"));
}

TEST(Combinations, AreFuzzySets) {
  const Mesh mesh = test::sphere(20, 24);
  using Kind = CombinedRegion::Kind;
  std::vector<RegionOfInterest> regions = {{"top", ball({0, 1, 0}, 0.2, 1.5)},
                                           {"side", ball({1, 0, 0}, 0.1, 1.2)}};
  const auto both = [&](Kind kind) {
    auto all = regions;
    all.push_back({"both", CombinedRegion{kind, {0, 1}}});
    return last_distance(mesh, all);
  };
  const Eigen::VectorXd top = last_distance(mesh, {regions[0], regions[1], regions[0]});
  const Eigen::VectorXd side = last_distance(mesh, regions);
  EXPECT_LT((both(Kind::Union) - top.cwiseMin(side)).cwiseAbs().maxCoeff(), 1e-15);
  EXPECT_LT((both(Kind::Intersection) - top.cwiseMax(side)).cwiseAbs().maxCoeff(), 1e-15);
  const Eigen::VectorXd without = top.cwiseMax((1 - side.array()).matrix());
  EXPECT_LT((both(Kind::Difference) - without).cwiseAbs().maxCoeff(), 1e-15);
  const Eigen::VectorXd rest = 1 - top.cwiseMin(side).array();
  EXPECT_LT((both(Kind::RestOf) - rest).cwiseAbs().maxCoeff(), 1e-15);
}

TEST(Combinations, MayNameLaterRegions) {
  const Mesh mesh = test::sphere(20, 24);
  const RegionFields fields = region_fields(
      twins(mesh), recipe_with({{"rest", CombinedRegion{CombinedRegion::Kind::RestOf, {1}}},
                                {"top", ball({0, 1, 0}, 0.2, 1.5)}}));
  EXPECT_EQ(fixed_distance(fields, 0), (1 - fixed_distance(fields, 1).array()).matrix());
}

TEST(Falloffs, KeepTheEndsAndTheMiddle) {
  for (const Falloff falloff : {Falloff::Linear, Falloff::Smoothstep, Falloff::Cosine}) {
    const Eigen::VectorXd d = bent_by(falloff, Vector3d(0, 0.5, 1));
    EXPECT_LT((d - Vector3d(0, 0.5, 1)).cwiseAbs().maxCoeff(), 1e-15);
  }
  EXPECT_NEAR(bent_by(Falloff::Smoothstep, Vector3d::Constant(0.25))(0), 0.15625, 1e-15);
  EXPECT_NEAR(bent_by(Falloff::Cosine, Vector3d::Constant(0.25))(0), (1 - std::sqrt(0.5)) / 2,
              1e-15);
}

/// Distance of a point from the polygon through points, closed.
double distance_from(const std::vector<Vector3d>& polygon, const Vector3d& point) {
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vector3d a = polygon[i], way = polygon[(i + 1) % polygon.size()] - a;
    const double share = std::clamp((point - a).dot(way) / way.squaredNorm(), 0.0, 1.0);
    least = std::min(least, (point - a - share * way).norm());
  }
  return least;
}

TEST(RingsOfFewPoints, KeepToTheGeodesics) {
  // On a grid, whose diagonals lead one way, many ways along edges are equally short, far apart.
  const Mesh mesh = test::grid(61, 61);
  const auto square = [&](double radius) {
    std::vector<Vector3d> corners;
    for (int i = 0; i < 4; ++i) {
      const double angle = 0.6 + i * std::numbers::pi / 2;
      corners.emplace_back(30 + radius * std::cos(angle), 30 + radius * std::sin(angle), 0);
    }
    return corners;
  };
  const auto points = [&](const std::vector<Vector3d>& corners) {
    PointSet set;
    for (const Vector3d& corner : corners) set.push_back(closest_point(mesh, corner));
    return set;
  };
  const std::vector<Vector3d> inner = square(12), outer = square(20);
  GeodesicDistances geodesics(mesh);
  const Rings rings = find_rings(mesh, points(inner), points(outer), &geodesics, {});
  for (const int v : rings.inner) {
    EXPECT_LT(distance_from(inner, mesh.positions.row(v)), 2.5) << mesh.positions.row(v);
  }
  for (const int v : rings.outer) {
    EXPECT_LT(distance_from(outer, mesh.positions.row(v)), 2.5) << mesh.positions.row(v);
  }
}

TEST(RingsAlongEdges, MayCrossVerticesAtOnePlace) {
  // Three columns of the grid are folded into one: ways between them have no length.
  Mesh mesh = test::grid(31, 31);
  for (auto row : mesh.positions.rowwise()) {
    if (row.x() == 14 || row.x() == 16) row.x() = 15;
  }
  const auto square = [&](double radius) {
    PointSet set;
    for (const double dx : {-radius, radius}) {
      for (const double dy : {-radius, radius}) {
        set.push_back(closest_point(mesh, {15 + dx, 15 + (dx < 0 ? dy : -dy), 0}));
      }
    }
    return set;
  };
  const Rings rings = find_rings(mesh, square(5), square(10), nullptr, {});
  EXPECT_TRUE(rings.is_inside[15 * 31 + 15]);
  EXPECT_FALSE(rings.is_inside[15 * 31 + 7]);
  EXPECT_FALSE(rings.is_outside[15 * 31 + 7]);
  EXPECT_TRUE(rings.is_outside[0]);
}

TEST(Scattered, BendAsLittleAsTheyCanBetweenTheirPoints) {
  // A torus with 1 on its first ring and 0 on the one across. Values that depend on the ring r
  // alone bend least when their fourth differences vanish at every other ring: a cubic in r, which
  // continued across either end is even there, 1 + B r + C r^2 + D r^3 with B = -D.
  const int n = 20;
  const Mesh mesh = test::torus(2 * n, 9);
  ScatteredRegion scattered{0, {}};
  for (int v = 0; v < 9; ++v) {
    scattered.values.push_back({"", Vector3d(mesh.positions.row(v)), 1.0});
    scattered.values.push_back({"", Vector3d(mesh.positions.row(9 * n + v)), 0.0});
  }
  const Eigen::VectorXd d = last_distance(mesh, {{"s", scattered}});
  const double D = 1 / (n + 0.5 * n * n * n), C = -1.5 * D * n;
  for (Eigen::Index v = 0; v < d.size(); ++v) {
    const double ring = static_cast<double>(v / 9), r = std::min(ring, 2 * n - ring);
    EXPECT_NEAR(1 - d(v), 1 - D * r + C * r * r + D * r * r * r, 1e-9) << v;
  }
}

TEST(Scattered, HaveOneValueAtAVertex) {
  const Mesh mesh = test::grid(5, 5);
  const ScatteredRegion twice{0, {{"a", Vector3d(0, 0, 0), 1.0}, {"b", Vector3d(0, 0.1, 0), 0.5}}};
  EXPECT_THAT(problem_of(mesh, {{"s", twice}}),
              testing::HasSubstr("\"a\", which has another value"));
}

TEST(Scattered, NeedAPointOnEachPiece) {
  const Mesh mesh = test::joined(test::grid(5, 5), test::sphere(8, 10));
  EXPECT_THAT(problem_of(mesh, {{"s", ScatteredRegion{0, {{"", Vector3d(0, 0, 0), 1.0}}}}}),
              testing::HasSubstr("no point of this region lies on the one at"));
}

TEST(Floods, TakeVerticesOneByOneEvenly) {
  const Mesh mesh = test::sphere(20, 24);
  const FloodRegion flood{0, {Vector3d(0, 1, 0)}, DistanceMeasure::Hops, 0};
  const RegionFields fields = region_fields(twins(mesh), recipe_with({{"f", flood}}));
  const auto count = static_cast<double>(mesh.positions.rows());
  for (const double amount : {0.0, 0.25, 0.5, 1.0}) {
    const Eigen::VectorXd d = distance_at(fields, 0, {0, amount});
    EXPECT_NEAR((1 - d.array()).sum(), std::ceil(amount * count), 1.5) << amount;
    double last_inside = -2, first_outside = 2;  // heights: the flood comes from the top
    for (Eigen::Index v = 0; v < d.size(); ++v) {
      EXPECT_TRUE(d(v) == 0 || d(v) == 1);
      const double depth = -mesh.positions(v, 1);
      if (d(v) == 0) last_inside = std::max(last_inside, depth);
      if (d(v) == 1) first_outside = std::min(first_outside, depth);
    }
    EXPECT_LE(last_inside, first_outside + 1e-12) << amount;
  }
}

TEST(Floods, HaveASoftFrontThatStartsEmptyAndEndsFull) {
  const Mesh mesh = test::sphere(40, 60);
  const FloodRegion flood{0, {Vector3d(0, 1, 0)}, DistanceMeasure::Geodesic, 0.25};
  const RegionFields fields = region_fields(twins(mesh), recipe_with({{"f", flood}}));
  EXPECT_EQ(distance_at(fields, 0, {0, 0}).minCoeff(), 1);
  EXPECT_EQ(distance_at(fields, 0, {0, 1}).maxCoeff(), 0);
  const Eigen::VectorXd d = distance_at(fields, 0, {0, 0.5});
  for (Eigen::Index v = 0; v < d.size(); ++v) {
    const double order = std::acos(std::clamp(mesh.positions(v, 1), -1.0, 1.0)) / M_PI;
    const double exact = 1 - std::clamp((0.5 * 1.25 - order) / 0.25, 0.0, 1.0);
    EXPECT_NEAR(d(v), exact, 0.04 / 0.25 + 0.01);  // 4 % of the way over the front's width
  }
}

TEST(Floods, NeedASeedOnEachPiece) {
  const Mesh mesh = test::joined(test::grid(5, 5), test::sphere(8, 10));
  EXPECT_THAT(problem_of(mesh, {{"f", FloodRegion{0, {Vector3d(0, 0, 0)}}}}),
              testing::HasSubstr("#/regions/f/flood: error:"));
}

TEST(Regions, DoNotDependOnTheOrderOfVertices) {
  const Mesh mesh = test::sphere(30, 40);
  std::vector<int> place(static_cast<std::size_t>(mesh.positions.rows()));
  std::iota(place.begin(), place.end(), 0);
  std::shuffle(place.begin(), place.end(), std::mt19937(7));
  Mesh shuffled = mesh;
  for (std::size_t v = 0; v < place.size(); ++v) {
    shuffled.positions.row(place[v]) = mesh.positions.row(static_cast<Eigen::Index>(v));
  }
  for (int& vertex : shuffled.triangles.reshaped())
    vertex = place[static_cast<std::size_t>(vertex)];
  const std::vector<RegionOfInterest> regions = {
      {"ball", ball({0, 1, 0}, 0.2, 1.5)},
      {"rings", RingsRegion{0, circle(0.6, 8), circle(0, 8)}},
      {"scattered",
       ScatteredRegion{0, {{"", Vector3d(0, 1, 0), 1.0}, {"", Vector3d(0, -1, 0), 0.0}}}},
      {"flood", FloodRegion{0, {Vector3d(0, 1, 0)}, DistanceMeasure::Edges, 0}}};
  for (const RegionOfInterest& region : regions) {
    const Eigen::VectorXd d = last_distance(mesh, {region}, {0, 0.5});
    const Eigen::VectorXd other = last_distance(shuffled, {region}, {0, 0.5});
    EXPECT_GE(d.minCoeff(), 0) << region.name;
    EXPECT_LE(d.maxCoeff(), 1) << region.name;
    EXPECT_LT((other(place) - d).cwiseAbs().maxCoeff(), 1e-8) << region.name;
  }
}

}  // namespace
}  // namespace morphbake
