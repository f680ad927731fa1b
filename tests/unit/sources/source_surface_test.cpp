#include "morphbake/sources/source_surface.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include "morphbake/sources/common_landmarks.h"
#include "shapes/shapes.h"
#include "shapes/sources.h"

namespace morphbake {
namespace {

using test::source_of;
using test::split_apart;

/// Gives a source one primitive with these normals.
SourceMesh with_normals(SourceMesh source, const Positions& normals) {
  PrimitiveGeometry primitive;
  primitive.triangles = source.triangles;
  primitive.positions = source.positions.cast<float>();
  primitive.normals = normals.cast<float>();
  source.geometry.primitives = {primitive};
  return source;
}

Positions flat_normals(const Mesh& split) {
  Positions normals(split.positions.rows(), 3);
  for (Eigen::Index f = 0; f < split.triangles.rows(); ++f) {
    const Eigen::Vector3d a = split.positions.row(3 * f), b = split.positions.row(3 * f + 1),
                          c = split.positions.row(3 * f + 2);
    for (int k = 0; k < 3; ++k) normals.row(3 * f + k) = (b - a).cross(c - a).normalized();
  }
  return normals;
}

Mesh cube() {
  Mesh mesh{Positions(8, 3), Triangles(12, 3)};
  for (int v = 0; v < 8; ++v) mesh.positions.row(v) << (v & 1), (v >> 1 & 1), (v >> 2);
  mesh.triangles << 0, 2, 3, 0, 3, 1, 4, 5, 7, 4, 7, 6, 0, 1, 5, 0, 5, 4, 2, 6, 7, 2, 7, 3, 0, 4, 6,
      0, 6, 2, 1, 3, 7, 1, 7, 5;
  return mesh;
}

std::vector<Eigen::Vector2i> hard_edges_of(const SourceMesh& source) {
  return source_surface(source, {}, {}).hard_edges;
}

TEST(SourceSurface, RefusesWhatIsNoManifold) {
  Mesh mesh = test::grid(3, 3);
  mesh.triangles.conservativeResize(9, 3);
  mesh.triangles.row(8) << 4, 0, 8;
  EXPECT_THROW(source_surface(source_of(mesh, "a"), {}, {}), BakeError);
  mesh.triangles.resize(0, 3);
  EXPECT_THROW(source_surface(source_of(mesh, "a"), {}, {}), BakeError);
}

TEST(SourceSurface, RefusesHubsOfThousandsOfTriangles) {
  std::vector<Problem> problems;
  source_surface(source_of(test::sphere(2, 20000), "a"), {}, {}, problems);
  ASSERT_EQ(problems.size(), 1U);
  EXPECT_EQ(problems[0].code, "connectivity.hub");
  EXPECT_NE(problems[0].message.find("20000 triangles"), std::string::npos) << problems[0].message;
}

TEST(SourceSurface, TellsOfLandmarksOfASurfaceThatIsNoManifold) {
  Mesh mesh = test::grid(3, 3);
  mesh.triangles.conservativeResize(9, 3);
  mesh.triangles.row(8) << 4, 0, 8;
  SourceRef ref;
  ref.landmarks = {{"far", Eigen::Vector3d(0, 0, 50)}};
  std::vector<Problem> problems;
  const SourceSurface surface = source_surface(source_of(mesh, "a"), ref, {}, problems);
  ASSERT_EQ(problems.size(), 2U);
  EXPECT_EQ(problems[0].code, "connectivity.not-manifold");
  EXPECT_EQ(problems[1].code, "landmarks.off-surface");
  EXPECT_EQ(surface.mesh.triangles.rows(), 0);
  EXPECT_EQ(surface.landmark_names.size(), 1U);
}

TEST(SourceSurface, DropsDegenerateAndRepeatedTriangles) {
  Mesh mesh = test::sphere(8, 10);
  const Eigen::Index count = mesh.triangles.rows();
  mesh.triangles.conservativeResize(count + 3, 3);
  mesh.triangles.bottomRows(3) << 3, 3, 4, mesh.triangles.row(5), mesh.triangles.row(7).reverse();
  const SourceSurface surface = source_surface(source_of(mesh, "a"), {}, {});
  EXPECT_EQ(surface.mesh.triangles.rows(), count);
  EXPECT_EQ(surface.render_of_corner.size(), static_cast<std::size_t>(3 * count));
  EXPECT_EQ(surface.repairs.degenerate, 1);
  EXPECT_EQ(surface.repairs.duplicate, 2);
}

std::vector<Problem> warnings_of(const Mesh& mesh) {
  std::vector<Problem> warnings;
  Observer observer;
  observer.on_problem = [&](const Problem& problem) { warnings.push_back(problem); };
  source_surface(source_of(mesh, "a"), {}, observer);
  return warnings;
}

TEST(SourceSurface, WarnsOfWhatItMendedAndOfOpenSeams) {
  EXPECT_TRUE(warnings_of(test::sphere(8, 10)).empty());
  Mesh mesh = test::sphere(8, 10);
  std::swap(mesh.triangles(7, 0), mesh.triangles(7, 1));
  Mesh beside = test::grid(3, 3);
  beside.positions.col(0).array() += 2 + 1e-7;
  mesh.positions.col(2).array() += 5;
  mesh = test::joined(mesh, test::joined(test::grid(3, 3), beside));
  const std::vector<Problem> warnings = warnings_of(mesh);
  ASSERT_EQ(warnings.size(), 2U);
  EXPECT_EQ(warnings[0].code, "connectivity.repaired");
  EXPECT_THAT(warnings[0].message, testing::StartsWith("of \"a\": 1 triangle is turned"));
  EXPECT_EQ(warnings[1].code, "connectivity.open-seams");
  EXPECT_THAT(warnings[1].message, testing::StartsWith("4 border edges of \"a\" lie beside"));
  for (const Problem& warning : warnings) EXPECT_EQ(warning.severity, Severity::Warning);
}

TEST(SourceSurface, KnowsItsRenderVertices) {
  const SourceMesh source = source_of(split_apart(test::sphere(8, 10)), "a");
  const SourceSurface surface = source_surface(source, {}, {});
  EXPECT_EQ(surface.mesh.positions.rows(), test::sphere(8, 10).positions.rows());
  for (std::size_t c = 0; c < surface.render_of_corner.size(); ++c) {
    const int render = surface.render_of_corner[c];
    const int vertex = surface.mesh.triangles.data()[c];
    EXPECT_EQ(surface.vertex_of_render[static_cast<std::size_t>(render)], vertex);
    EXPECT_EQ(surface.mesh.positions.row(vertex), source.positions.row(render));
  }
}

TEST(HardEdges, AreNoneOnSmoothShading) {
  const Mesh sphere = test::sphere(12, 16);
  EXPECT_TRUE(hard_edges_of(with_normals(source_of(sphere, "a"), sphere.positions)).empty());
}

TEST(HardEdges, AreNotAllOfAFlatShadedSurface) {
  const Mesh split = split_apart(test::sphere(12, 16));
  EXPECT_TRUE(hard_edges_of(with_normals(source_of(split, "a"), flat_normals(split))).empty());
  EXPECT_TRUE(hard_edges_of(source_of(split, "a")).empty());
}

TEST(HardEdges, AreTheTwelveOfACube) {
  const Mesh split = split_apart(cube());
  EXPECT_EQ(hard_edges_of(with_normals(source_of(split, "a"), flat_normals(split))).size(), 12U);
  EXPECT_EQ(hard_edges_of(source_of(cube(), "a")).size(), 12U);
}

TEST(HardEdges, AreNoneBesideATriangleThatIsTurned) {
  Mesh sphere = test::sphere(12, 16);
  std::swap(sphere.triangles(50, 1), sphere.triangles(50, 2));
  Mesh split = split_apart(sphere);
  Positions normals = split.positions;  // smooth, but inward on the triangle that is turned
  normals.middleRows(150, 3) *= -1;
  EXPECT_TRUE(hard_edges_of(with_normals(source_of(split, "a"), normals)).empty());
}

TEST(HardEdges, NeedTheBreakAtBothEnds) {
  // A flat grid, smooth but for one triangle whose normals are tilted at two of its corners.
  const Mesh split = split_apart(test::grid(9, 9));
  Positions normals = flat_normals(split);
  normals.row(0) << 0, 0.5, 1;
  EXPECT_TRUE(hard_edges_of(with_normals(source_of(split, "a"), normals)).empty());
  normals.row(1) << 0, 0.5, 1;
  normals.row(2) << 0, 0.5, 1;
  EXPECT_EQ(hard_edges_of(with_normals(source_of(split, "a"), normals)).size(),
            2U);  // the third side is on the boundary
}

SourceSurface named(const std::string& name, const std::vector<std::string>& landmarks) {
  SourceSurface surface;
  surface.name = name;
  surface.file = name + ".glb";
  for (const std::string& landmark : landmarks) {
    surface.landmark_names.push_back(landmark);
    surface.landmarks.push_back({landmark.front(), {1, 0, 0}});
  }
  return surface;
}

SourceRef in_recipe(const SourceSurface& surface) {
  const std::string& name = surface.name;
  SourceRef ref;
  ref.name = name;
  for (const std::string& landmark : surface.landmark_names) {
    ref.landmarks.push_back({landmark, VertexPlace{0}});
  }
  ref.landmarks_at = {"recipe.json", "/sources/" + name + "/landmarks"};
  return ref;
}

TEST(CommonLandmarks, FewerThanThreeAreTooFew) {
  const SourceSurface x = named("x", {"a", "b", "c"}), y = named("y", {"b", "c", "d"});
  try {
    with_common_landmarks({x, y}, {in_recipe(x), in_recipe(y)}, {});
    FAIL();
  } catch (const BakeError& error) {
    ASSERT_EQ(error.problems().size(), 3U);
    EXPECT_EQ(error.problems()[0].code, "landmarks.too-few");
    EXPECT_EQ(error.problems()[0].location.pointer, "/sources/x/landmarks");
    EXPECT_EQ(error.problems()[1].code, "landmarks.missing");
    EXPECT_THAT(error.problems()[1].message, testing::HasSubstr("\"x\" lacks"));
    EXPECT_THAT(error.problems()[1].message, testing::EndsWith(": d"));
    EXPECT_THAT(error.problems()[2].message, testing::EndsWith(": a"));
    EXPECT_EQ(error.problems()[2].location.pointer, "/sources/y/landmarks");
  }
}

TEST(CommonLandmarks, StandInOneOrderAndTheRestIsTold) {
  Observer observer;
  std::vector<Problem> warnings;
  observer.on_problem = [&](const Problem& problem) { warnings.push_back(problem); };
  const SourceSurface x = named("x", {"a", "b", "c", "d"}), y = named("y", {"d", "c", "b"});
  const auto surfaces = with_common_landmarks({x, y}, {in_recipe(x), in_recipe(y)}, observer);
  for (const SourceSurface& surface : surfaces) {
    EXPECT_EQ(surface.landmark_names, (std::vector<std::string>{"b", "c", "d"}));
    ASSERT_EQ(surface.landmarks.size(), 3U);
    for (std::size_t i = 0; i < 3; ++i) {
      EXPECT_EQ(surface.landmarks[i].triangle, surface.landmark_names[i].front());
    }
  }
  ASSERT_EQ(warnings.size(), 1U);
  EXPECT_EQ(warnings[0].code, "landmarks.missing");
  EXPECT_EQ(warnings[0].severity, Severity::Warning);
  EXPECT_EQ(warnings[0].location.file, "recipe.json");
}

}  // namespace
}  // namespace morphbake
