#include "morphbake/connectivity/measure_triangulation.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "morphbake/mesh/closest_point.h"
#include "shapes/shapes.h"

namespace morphbake {
namespace {

SourceSurface surface_of(const Mesh& mesh) {
  SourceSurface surface;
  surface.name = "a";
  surface.mesh = mesh;
  return surface;
}

SharedTriangulation triangulation_of(const Mesh& mesh, const std::vector<Positions>& geometries) {
  SharedTriangulation triangulation;
  triangulation.connectivity = {static_cast<int>(mesh.positions.rows()), mesh.triangles};
  triangulation.geometries = geometries;
  for (const Positions& geometry : geometries) {
    triangulation.on_source.push_back(closest_points(mesh, geometry));
  }
  return triangulation;
}

TEST(MeasureTriangulation, FindsNothingWrongWithEqualMeshes) {
  const Mesh mesh = test::sphere(12, 16);
  const TriangulationQuality quality =
      measure_triangulation({surface_of(mesh), surface_of(mesh)},
                            triangulation_of(mesh, {mesh.positions, mesh.positions}));
  ASSERT_EQ(quality.maps.size(), 1U);
  EXPECT_NEAR(quality.maps[0].mean, 1, 1e-12);
  EXPECT_NEAR(quality.maps[0].maximum, 1, 1e-9);
  EXPECT_TRUE(quality.regions.empty());
  for (const SourceQuality& source : quality.sources) {
    EXPECT_LT(source.source_to_remesh, 1e-4);
    EXPECT_LT(source.remesh_to_source, 1e-4);
    EXPECT_EQ(source.folds, 0);
    EXPECT_EQ(source.self_intersections, 0);
  }
}

TEST(MeasureTriangulation, TellsTheDistortionOfAStretch) {
  const Mesh mesh = test::grid(5, 5);
  Positions stretched = mesh.positions;
  stretched.col(0) *= 2;
  // Scaled to equal areas, the stretch by 2 and 1 is one by sqrt 2 and 1 / sqrt 2.
  const Eigen::VectorXd distortion = map_distortion(mesh.positions, stretched, mesh.triangles);
  EXPECT_NEAR(distortion.minCoeff(), 1.25, 1e-12);
  EXPECT_NEAR(distortion.maxCoeff(), 1.25, 1e-12);
}

TEST(MeasureTriangulation, TellsTheSagittaOfACoarserCircle) {
  // The flat sides of a prism's coarse hoop miss the fine hoop by r (1 - cos(pi / n)).
  const Mesh fine = test::sphere(60, 120), coarse = test::sphere(60, 12);
  const TriangulationQuality quality =
      measure_triangulation({surface_of(fine)}, triangulation_of(coarse, {coarse.positions}));
  const double sagitta = 1 - std::cos(std::numbers::pi / 12);
  const double diagonal = 2 * std::sqrt(3.0);
  EXPECT_NEAR(quality.sources[0].source_to_remesh, sagitta / diagonal, 3e-4);
}

TEST(MeasureTriangulation, CountsOneFoldForATurnedTriangle) {
  const Mesh mesh = test::grid(6, 6);
  Mesh folded = mesh;
  // The middle of the fan around an inner vertex goes over one of its edges.
  folded.positions.row(14) << 2.4, 3.2, 0;
  const TriangulationQuality quality =
      measure_triangulation({surface_of(mesh)}, triangulation_of(folded, {folded.positions}));
  EXPECT_EQ(quality.sources[0].folds, 1);
}

TEST(MeasureTriangulation, CountsPairsThatCutOneAnother) {
  Mesh pair{Positions(6, 3), Triangles(2, 3)};
  pair.positions << -1, -1, 0, 1, -1, 0, 0, 1, 0, 0, 0, -1, 0, 0, 1, 0, 5, 0;
  pair.triangles << 0, 1, 2, 3, 4, 5;
  const TriangulationQuality quality =
      measure_triangulation({surface_of(pair)}, triangulation_of(pair, {pair.positions}));
  EXPECT_EQ(quality.sources[0].self_intersections, 1);
  EXPECT_EQ(quality.sources[0].source_self_intersections, 1);
  EXPECT_EQ(quality.sources[0].new_self_intersections, 0);
}

TEST(MeasureTriangulation, CallsPairsNewWhereTheSourceDoesNotCutItself) {
  Mesh pair{Positions(6, 3), Triangles(2, 3)};
  pair.positions << -1, -1, 0, 1, -1, 0, 0, 1, 0, 0, 0, 0.1, 0, 0, 1, 0, 5, 1;
  pair.triangles << 0, 1, 2, 3, 4, 5;
  Positions cut = pair.positions;
  cut.row(3) << 0, 0, -0.1;
  const TriangulationQuality quality =
      measure_triangulation({surface_of(pair)}, triangulation_of(pair, {cut}));
  EXPECT_EQ(quality.sources[0].self_intersections, 1);
  EXPECT_EQ(quality.sources[0].source_self_intersections, 0);
  EXPECT_EQ(quality.sources[0].new_self_intersections, 1);
}

TEST(MeasureTriangulation, ChecksTheSphereExactly) {
  const Mesh mesh = test::sphere(8, 10);
  SharedTriangulation triangulation = triangulation_of(mesh, {mesh.positions});
  triangulation.on_boundary.assign(static_cast<std::size_t>(mesh.positions.rows()), 0);
  triangulation.sphere = {mesh.positions};
  const SphereQuality good =
      *measure_triangulation({surface_of(mesh)}, triangulation).sources[0].sphere;
  EXPECT_EQ(good.flipped_triangles, 0);
  EXPECT_NEAR(good.covering, 1, 1e-12);
  triangulation.sphere[0].row(0) = -triangulation.sphere[0].row(0);
  EXPECT_GT(
      measure_triangulation({surface_of(mesh)}, triangulation).sources[0].sphere->flipped_triangles,
      0);
}

TEST(MeasureTriangulation, NamesTheLandmarkNearestToADistortedRegion) {
  const Mesh mesh = test::grid(12, 12);
  Positions pulled = mesh.positions;
  pulled(65, 2) = 40;  // one vertex far out of the plane
  SharedTriangulation triangulation = triangulation_of(mesh, {mesh.positions, pulled});
  triangulation.landmarks = {0, 66};
  const auto regions = find_distortion_regions(triangulation, 1, {"corner", "near"});
  ASSERT_FALSE(regions.empty());
  EXPECT_EQ(regions[0].nearest_landmark, "near");
}

}  // namespace
}  // namespace morphbake
