#include "morphbake/connectivity/mend.h"

#include <gtest/gtest.h>

#include <cmath>

#include "morphbake/connectivity/distant_triangles.h"
#include "morphbake/connectivity/surface_checks.h"
#include "morphbake/correspondence/spherical_map.h"
#include "morphbake/mesh/closest_point.h"
#include "shapes/surfaces.h"

namespace morphbake {
namespace {

const Eigen::Vector3d kHornDirection = Eigen::Vector3d(0.8, 0.3, 0.6).normalized();
constexpr double kHornWidth = 0.12;  // radians

/// Two spheres, one with a horn that is narrower than the triangles of a coarse triangulation.
std::vector<SourceSurface> sphere_and_horn() {
  Mesh horned = test::sphere(60, 90);
  for (auto row : horned.positions.rowwise()) {
    const double angle = std::acos(std::min(1.0, row.dot(kHornDirection.transpose())));
    row *= 1 + 0.6 * std::exp(-angle * angle / (kHornWidth * kHornWidth));
  }
  return {test::surface("even", test::sphere(30, 44), test::kAxes),
          test::surface("horned", horned, test::kAxes)};
}

constexpr std::size_t kHorned = 1;  // its layer
constexpr int kCoarse = 500;        // vertices
constexpr double kBound = 0.01;     // fraction of the diagonal: above the sagitta of coarse edges

class Mend : public testing::Test {
 protected:
  std::vector<SphericalMap> maps = map_to_sphere(sphere_and_horn(), {});
  LayeredTriangulation t = coarse_triangulation(maps, kCoarse);
  SourcePoints points = source_points(t);

  Mesh lifted(std::size_t layer) const {
    return lifted_mesh(t, t.layers[layer], surface_triangles(t));
  }

  /// Largest distance of one mesh's vertices and triangle middles from the other, of the diagonal.
  double distance(const Mesh& from, const Mesh& to, std::size_t layer) const {
    Positions samples(4 * from.triangles.rows(), 3);
    for (Eigen::Index f = 0; f < from.triangles.rows(); ++f) {
      samples.row(4 * f + 3).setZero();
      for (int k = 0; k < 3; ++k) {
        samples.row(4 * f + k) = from.positions.row(from.triangles(f, k));
        samples.row(4 * f + 3) += samples.row(4 * f + k) / 3;
      }
    }
    const std::vector<SurfacePoint> nearest = closest_points(to, samples);
    double worst = 0;
    for (Eigen::Index i = 0; i < samples.rows(); ++i) {
      const Eigen::RowVector3d there = position_of(to, nearest[static_cast<std::size_t>(i)]);
      worst = std::max(worst, (there - samples.row(i)).norm());
    }
    return worst / t.layers[layer].atlas.diagonal;
  }

  Mesh source(std::size_t layer) const { return t.layers[layer].atlas.mesh(); }
};

TEST_F(Mend, DistantTrianglesAreThoseAroundTheHorn) {
  ASSERT_GT(distance(source(kHorned), lifted(kHorned), kHorned), 1.5 * kBound);
  const std::vector<int> distant = distant_triangles(t, kHorned, points, kBound);
  ASSERT_FALSE(distant.empty());
  EXPECT_LT(distant.size(), surface_triangles(t).size() / 4);
  for (const int f : distant) {
    double nearest = 10;
    for (int k = 0; k < 3; ++k) {
      const auto v = static_cast<std::size_t>(t.mesh.from(3 * f + k));
      const Eigen::Vector3d place = t.layers[kHorned].lifted[v].normalized();
      nearest = std::min(nearest, std::acos(std::min(1.0, place.dot(kHornDirection))));
    }
    EXPECT_LT(nearest, 5 * kHornWidth) << "triangle " << f;
  }
  EXPECT_TRUE(distant_triangles(t, 0, points, kBound).empty());
  EXPECT_FALSE(distant_triangles(t, 0, points, kBound / 20).empty());
}

TEST_F(Mend, BringsEverySourceWithinTheError) {
  mend(t, points, kBound, 10000);
  for (std::size_t s = 0; s < 2; ++s) {
    EXPECT_TRUE(distant_triangles(t, s, points, kBound).empty());
    EXPECT_LT(distance(source(s), lifted(s), s), kBound);
    EXPECT_LT(distance(lifted(s), source(s), s), kBound);
    EXPECT_TRUE(self_intersections(lifted(s)).empty());
  }
  for (int f = 0; f < t.mesh.triangle_slots(); ++f) {
    if (!t.mesh.has_triangle(f)) continue;
    const int a = t.mesh.from(3 * f), b = t.mesh.from(3 * f + 1), c = t.mesh.from(3 * f + 2);
    EXPECT_TRUE(is_positive_everywhere(t, a, b, c));
    for (const Layer& layer : t.layers) {
      EXPECT_GT(area_normal(layer, a, b, c).dot(normal_below(layer, a, b, c)), 0);
    }
  }
}

TEST_F(Mend, KeepsToTheVertexLimitAndTheBestOfItsRounds) {
  const int count = t.vertex_count();
  const double before = distance(source(kHorned), lifted(kHorned), kHorned);
  mend(t, points, kBound, count);
  EXPECT_LE(t.vertex_count(), count);
  EXPECT_LE(distance(source(kHorned), lifted(kHorned), kHorned), 1.1 * before);
}

TEST(MendOfTangledSources, ComesToAnEnd) {
  Mesh tangled = test::sphere(16, 20);
  tangled.positions.setRandom();  // of a fixed seed
  std::vector<SourceSurface> sources{test::surface("even", test::sphere(16, 20), test::kAxes),
                                     test::surface("tangled", tangled, {})};
  sources[1].landmark_names = sources[0].landmark_names;
  sources[1].landmarks = sources[0].landmarks;  // in the same triangles
  const std::vector<SphericalMap> maps = map_to_sphere(sources, {});
  LayeredTriangulation t = coarse_triangulation(maps, 200);
  SourcePoints points = source_points(t);
  mend(t, points, kBound, 1000);
  EXPECT_LE(t.vertex_count(), 1000);
}

}  // namespace
}  // namespace morphbake
