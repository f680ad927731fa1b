#include "morphbake/sources/places.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "morphbake/mesh/closest_point.h"
#include "morphbake/sources/source_surface.h"
#include "shapes/shapes.h"
#include "shapes/sources.h"

namespace morphbake {
namespace {

using test::source_of;
using testing::HasSubstr;

SourceRef ref_of(std::vector<Landmark> landmarks) {
  return {"a", "a.glb", std::move(landmarks), {"a.landmarks.json", "/landmarks"}};
}

/// What is said about landmarks that cannot be placed.
std::string problems_of(const SourceMesh& source, std::vector<Landmark> landmarks) {
  try {
    source_surface(source, ref_of(std::move(landmarks)), {});
  } catch (const BakeError& error) {
    return error.what();
  }
  return "";
}

SurfacePoint placed(const SourceMesh& source, const Place& place) {
  return source_surface(source, ref_of({{"x", place}}), {}).landmarks.front();
}

TEST(LandmarkPoints, SayAllThatIsWrongAtOnce) {
  Mesh mesh = test::grid(5, 5);
  mesh.positions.conservativeResize(26, 3);
  mesh.positions.row(25) << 2, 2, 1;  // used by no triangle
  mesh.triangles.conservativeResize(34, 3);
  mesh.triangles.row(32) << 0, 0, 1;               // without area
  mesh.triangles.row(33) = mesh.triangles.row(3);  // again
  const std::string said =
      problems_of(source_of(mesh, "a"), {{"a/b", VertexPlace{26}},
                                         {"face", TrianglePlace{34, {1, 0, 0}}},
                                         {"unused", VertexPlace{25}},
                                         {"flat", TrianglePlace{32, {1, 0, 0}}},
                                         {"twin", TrianglePlace{33, {1, 0, 0}}},
                                         {"far", Eigen::Vector3d(2, 2, 3)}});
  EXPECT_THAT(said, HasSubstr("a.landmarks.json#/landmarks/a~1b: error: there is no vertex 26: the "
                              "mesh has 26 [landmarks.out-of-range]"));
  EXPECT_THAT(said, HasSubstr("#/landmarks/face: error: there is no face 34: the mesh has 34"));
  EXPECT_THAT(said, HasSubstr("#/landmarks/unused: error: no triangle of \"a\" uses vertex 25 "
                              "[landmarks.unused-vertex]"));
  EXPECT_THAT(said, HasSubstr("#/landmarks/flat: error: face 32 of \"a\" is no part of its"));
  EXPECT_THAT(said, HasSubstr("#/landmarks/twin: error: face 33 of \"a\" is no part of its"));
  EXPECT_THAT(said, HasSubstr("#/landmarks/far: error: (2, 2, 3) is 53 % of the diagonal away from "
                              "the surface of \"a\"; the closest point is (2, 2, 0) "
                              "[landmarks.off-surface]"));
}

TEST(LandmarkPoints, TwoAtOnePointAreNamed) {
  const std::string said =
      problems_of(source_of(test::grid(5, 5), "a"), {{"nose", Eigen::Vector3d(2, 2, 0)},
                                                     {"ear", Eigen::Vector3d(1, 1, 0)},
                                                     {"tip", VertexPlace{12}}});
  EXPECT_THAT(said, HasSubstr("#/landmarks/tip: error: \"nose\" and \"tip\" lie at one point of "
                              "\"a\" [landmarks.same-point]"));
  EXPECT_THAT(said, testing::Not(HasSubstr("ear")));
}

TEST(LandmarkPoints, WarnOfPositionsThatAreOff) {
  Observer observer;
  std::vector<Problem> warnings;
  observer.on_problem = [&](const Problem& problem) { warnings.push_back(problem); };
  const SourceSurface surface = source_surface(
      source_of(test::grid(5, 5), "a"),
      ref_of({{"off", Eigen::Vector3d(1, 1, 0.2)}, {"on", Eigen::Vector3d(3, 3, 0.01)}}), observer);
  ASSERT_EQ(warnings.size(), 1U);
  EXPECT_EQ(warnings[0].code, "landmarks.off-surface");
  EXPECT_EQ(warnings[0].location.pointer, "/landmarks/off");
  EXPECT_LT((position_of(surface.mesh, surface.landmarks[0]) - Eigen::Vector3d(1, 1, 0)).norm(),
            1e-12);
}

TEST(LandmarkPoints, APositionInsideAFaceIsNoVertex) {
  const SourceMesh source = source_of(test::grid(5, 5), "a");
  const SurfacePoint point = placed(source, Eigen::Vector3d(1.6, 1.2, 0));
  EXPECT_GT(point.barycentric.minCoeff(), 0.1);
  EXPECT_LT(
      (position_of({source.positions, source.triangles}, point) - Eigen::Vector3d(1.6, 1.2, 0))
          .norm(),
      1e-12);
}

TEST(LandmarkPoints, VerticesAndFacePointsAreExact) {
  const SourceMesh source = source_of(test::split_apart(test::sphere(8, 10)), "a");
  const SourceSurface surface = source_surface(
      source, ref_of({{"v", VertexPlace{100}}, {"f", TrianglePlace{50, {0.5, 0.25, 0.25}}}}), {});
  EXPECT_EQ(position_of(surface.mesh, surface.landmarks[0]), source.positions.row(100).transpose());
  EXPECT_EQ(surface.landmarks[0].barycentric.maxCoeff(), 1);
  EXPECT_EQ(surface.landmarks[1].triangle, 50);
  EXPECT_EQ(surface.landmarks[1].barycentric, Eigen::Vector3d(0.5, 0.25, 0.25));
}

TEST(LandmarkPoints, AMirroringNodeTurnsTheCorners) {
  SourceMesh source = source_of(test::sphere(8, 10), "a");
  source.geometry.to_scene(0, 0) = -1;
  source.positions.col(0) *= -1;
  const SurfacePoint point = placed(source, TrianglePlace{50, {0.7, 0.2, 0.1}});
  EXPECT_EQ(point.barycentric, Eigen::Vector3d(0.7, 0.1, 0.2));
  const SourceSurface surface = source_surface(source, ref_of({}), {});
  const Eigen::Vector3d expected = scene_position(source, TrianglePlace{50, {0.7, 0.2, 0.1}}, {});
  EXPECT_LT((position_of(surface.mesh, point) - expected).norm(), 1e-15);
}

TEST(ScenePosition, OutOfRangeIsAProblem) {
  const SourceMesh source = source_of(test::grid(3, 3), "a");
  EXPECT_THROW(scene_position(source, VertexPlace{9}, {}), BakeError);
  EXPECT_THROW(scene_position(source, TrianglePlace{8, {1, 0, 0}}, {}), BakeError);
  EXPECT_EQ(scene_position(source, VertexPlace{8}, {}), Eigen::Vector3d(2, 2, 0));
}

}  // namespace
}  // namespace morphbake
