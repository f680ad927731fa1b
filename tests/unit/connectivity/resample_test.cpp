#include <gtest/gtest.h>

#include "morphbake/connectivity/measure_triangulation.h"
#include "morphbake/connectivity/shared_triangulation.h"
#include "morphbake/diagnostics/problem.h"
#include "morphbake/mesh/closest_point.h"
#include "morphbake/mesh/measures.h"
#include "shapes/shapes.h"

namespace morphbake {
namespace {

std::vector<SourceSurface> surfaces_of(const Mesh& mesh) {
  SourceSurface surface;
  surface.name = "a";
  surface.mesh = mesh;
  surface.landmark_names = {"inside", "on an edge", "at a corner"};
  surface.landmarks = {{3, {0.2, 0.3, 0.5}}, {7, {0.25, 0.75, 0}}, {11, {0, 1, 0}}};
  SourceSurface bent = surface;
  bent.mesh.positions = test::bent(mesh.positions, 0.3, 1);
  return {surface, bent};
}

std::string code_of(const std::vector<SourceSurface>& surfaces, const RemeshOptions& options) {
  try {
    resample(surfaces, options, {});
  } catch (const BakeError& error) {
    return error.problems().front().code;
  }
  return "";
}

TEST(Resample, RefusesSourcesOfDifferentTriangles) {
  std::vector<SourceSurface> surfaces = surfaces_of(test::sphere(8, 10));
  surfaces[1].mesh = test::sphere(10, 10);
  EXPECT_EQ(code_of(surfaces, {}), "connectivity.different-triangles");
}

TEST(Resample, RefusesMoreVerticesThanAllowedBeforeItMakesThem) {
  RemeshOptions options;
  options.target_edge_length = 1e-4;
  EXPECT_EQ(code_of(surfaces_of(test::sphere(8, 10)), options), "connectivity.too-many-vertices");
}

TEST(Resample, RefusesNeedlesThatMillionsOfSplitsWouldCut) {
  std::vector<SourceSurface> surfaces = surfaces_of(test::grid(100000, 2));
  for (SourceSurface& surface : surfaces) surface.mesh.positions.col(0) /= 100000;
  EXPECT_EQ(code_of(surfaces, {}), "connectivity.too-thin");
}

TEST(Resample, KeepsLandmarksBordersAndHardEdges) {
  std::vector<SourceSurface> surfaces = surfaces_of(test::grid(9, 9));
  for (SourceSurface& surface : surfaces) {
    for (int c = 0; c + 1 < 9; ++c) surface.hard_edges.emplace_back(36 + c, 36 + c + 1);
  }
  RemeshOptions options;
  options.target_edge_length = 0.04;
  options.sizing = Sizing::Uniform;
  const SharedTriangulation k = resample(surfaces, options, {});
  for (std::size_t i = 0; i < surfaces[0].landmarks.size(); ++i) {
    for (std::size_t s = 0; s < surfaces.size(); ++s) {
      const Mesh& mesh = surfaces[s].mesh;
      EXPECT_EQ(k.geometries[s].row(k.landmarks[i]),
                position_of(mesh, surfaces[s].landmarks[i]).transpose());
    }
  }
  EXPECT_GE(k.hard_edges.size(), 8U);
  for (const Eigen::Vector2i& edge : k.hard_edges) {
    EXPECT_EQ(k.geometries[0](edge(0), 1), 4);
    EXPECT_EQ(k.geometries[0](edge(1), 1), 4);
  }
  const Positions& flat = k.geometries[0];
  for (int v = 0; v < flat.rows(); ++v) {
    const bool on_border = flat(v, 0) == 0 || flat(v, 0) == 8 || flat(v, 1) == 0 || flat(v, 1) == 8;
    EXPECT_EQ(k.on_boundary[static_cast<std::size_t>(v)] != 0, on_border);
  }
  EXPECT_NEAR(triangle_areas(flat, k.connectivity.triangles).sum(), 64, 1e-9);
}

TEST(Resample, ReachesTheErrorThatIsAskedFor) {
  const std::vector<SourceSurface> surfaces = surfaces_of(test::sphere(40, 60));
  RemeshOptions coarse, fine;
  coarse.sizing = Sizing::Uniform;
  coarse.target_edge_length = fine.target_edge_length = 0.2;
  fine.max_error = 0.004;
  EXPECT_GT(resample(surfaces, fine, {}).connectivity.vertex_count,
            2 * resample(surfaces, coarse, {}).connectivity.vertex_count);
}

TEST(Resample, IsWithinTheErrorAsItIsMeasured) {
  const std::vector<SourceSurface> surfaces = surfaces_of(test::sphere(40, 60));
  RemeshOptions options;
  options.target_edge_length = 0.2;
  for (const double error : {0.02, 0.01, 0.005}) {
    options.max_error = error;
    const SharedTriangulation k = resample(surfaces, options, {});
    EXPECT_FALSE(k.is_full);
    for (const SourceQuality& quality : measure_triangulation(surfaces, k).sources) {
      EXPECT_LE(std::max(quality.source_to_remesh, quality.remesh_to_source), error);
    }
  }
}

TEST(Resample, UsesAllVerticesBeforeItLeavesTheErrorUnmet) {
  const std::vector<SourceSurface> surfaces = surfaces_of(test::sphere(40, 60));
  RemeshOptions options;
  options.target_edge_length = 0.2;
  options.max_error = 1e-5;
  for (const int limit : {1000, 1300, 1700}) {
    options.max_vertices = limit;
    const SharedTriangulation k = resample(surfaces, options, {});
    EXPECT_TRUE(k.is_full);
    EXPECT_GT(k.connectivity.vertex_count, 0.93 * limit);
    EXPECT_LE(k.connectivity.vertex_count, limit);
  }
}

TEST(Resample, StopsInsideOfARemeshingWhenItIsCancelled) {
  const std::vector<SourceSurface> surfaces = surfaces_of(test::sphere(40, 60));
  RemeshOptions options;
  options.target_edge_length = 0.02;
  Observer observer;
  int asked = 0, attempts = 0;
  observer.on_progress = [&](const Progress&) { ++attempts; };
  observer.is_cancelled = [&] { return ++asked == 50; };
  EXPECT_THROW(resample(surfaces, options, observer), Cancelled);
  EXPECT_EQ(asked, 50);
  EXPECT_EQ(attempts, 1);
}

}  // namespace
}  // namespace morphbake
