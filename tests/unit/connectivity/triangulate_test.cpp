#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "morphbake/connectivity/shared_triangulation.h"
#include "morphbake/correspondence/check_map.h"
#include "morphbake/correspondence/spherical_map.h"
#include "shapes/surfaces.h"

namespace morphbake {
namespace {

using test::surface;
using test::two_spheres;

void expect_shared(const std::vector<SourceSurface>& sources, const SharedTriangulation& shared,
                   bool is_disk) {
  for (std::size_t s = 0; s < sources.size(); ++s) {
    const SphereCheck check =
        check_sphere(shared.sphere[s], shared.connectivity.triangles, is_disk);
    EXPECT_EQ(check.turned, 0);
    EXPECT_NEAR(check.degree, 1, 1e-9);
    for (int v = 0; v < shared.connectivity.vertex_count; ++v) {
      const SurfacePoint& at = shared.on_source[s][static_cast<std::size_t>(v)];
      ASSERT_NEAR(at.barycentric.sum(), 1, 1e-12);
      Eigen::RowVector3d there = Eigen::RowVector3d::Zero();
      for (int k = 0; k < 3; ++k) {
        there += at.barycentric(k) *
                 sources[s].mesh.positions.row(sources[s].mesh.triangles(at.triangle, k));
      }
      ASSERT_LT((there - shared.geometries[s].row(v)).norm(), 1e-12);
    }
    for (std::size_t l = 0; l < shared.landmarks.size(); ++l) {
      const SurfacePoint& at = sources[s].landmarks[l];
      Eigen::RowVector3d there = Eigen::RowVector3d::Zero();
      for (int k = 0; k < 3; ++k) {
        there += at.barycentric(k) *
                 sources[s].mesh.positions.row(sources[s].mesh.triangles(at.triangle, k));
      }
      EXPECT_LT((there - shared.geometries[s].row(shared.landmarks[l])).norm(), 1e-12);
    }
  }
}

TEST(Triangulate, LiesOnClosedSourcesAndMeetsLandmarksExactly) {
  const std::vector<SourceSurface> sources = two_spheres();
  RemeshOptions options;
  options.max_error = 0.005;
  options.target_edge_length = 0.1;
  const std::vector<SphericalMap> maps = map_to_sphere(sources, {});
  const SharedTriangulation shared = triangulate(maps, options, {});
  expect_shared(sources, shared, false);
  const SharedTriangulation again = triangulate(maps, options, {});
  EXPECT_EQ(again.geometries[1], shared.geometries[1]);  // the same bytes each time
}

/// Edges of a mesh whose ends fulfil a condition.
template <typename Condition>
std::vector<Eigen::Vector2i> edges_where(const Mesh& mesh, const Condition& condition) {
  std::vector<Eigen::Vector2i> edges;
  for (const auto& triangle : mesh.triangles.rowwise()) {
    for (int k = 0; k < 3; ++k) {
      const int u = triangle(k), v = triangle((k + 1) % 3);
      if (u < v && condition(mesh.positions.row(u)) && condition(mesh.positions.row(v))) {
        edges.emplace_back(u, v);
      }
    }
  }
  return edges;
}

double segment_distance(const Eigen::RowVector3d& p, const Eigen::RowVector3d& a,
                        const Eigen::RowVector3d& b) {
  const double along = std::clamp((p - a).dot(b - a) / (b - a).squaredNorm(), 0.0, 1.0);
  return (p - a - along * (b - a)).norm();
}

TEST(Triangulate, LaysEdgesAlongTheHardEdgesOfEverySource) {
  std::vector<SourceSurface> sources = two_spheres();
  // A closed ring on one, on the other half a ring that crosses it.
  sources[0].hard_edges = edges_where(
      sources[0].mesh, [](const Eigen::RowVector3d& p) { return std::abs(p.y()) < 1e-9; });
  sources[1].hard_edges = edges_where(test::sphere(17, 23), [](const Eigen::RowVector3d& p) {
    return std::abs(p.x()) < 1e-9 && p.z() > 0.1;
  });
  ASSERT_EQ(sources[0].hard_edges.size(), 16u);
  ASSERT_GT(sources[1].hard_edges.size(), 8u);
  RemeshOptions options;
  options.max_error = 0.005;
  options.target_edge_length = 0.1;
  const SharedTriangulation shared = triangulate(map_to_sphere(sources, {}), options, {});
  expect_shared(sources, shared, false);
  EXPECT_EQ(shared.rounded_hard_edges, 0);
  std::set<std::pair<int, int>> edges;
  for (const auto& triangle : shared.connectivity.triangles.rowwise()) {
    for (int k = 0; k < 3; ++k) edges.insert(std::minmax(triangle(k), triangle((k + 1) % 3)));
  }
  for (const Eigen::Vector2i& edge : shared.hard_edges) {
    EXPECT_TRUE(edges.count({edge(0), edge(1)}));
  }
  for (std::size_t s = 0; s < 2; ++s) {
    const Positions& at = shared.geometries[s];
    for (const Eigen::Vector2i& edge : sources[s].hard_edges) {
      for (const double share : {0.0, 0.3, 0.5, 0.9}) {
        const Eigen::RowVector3d p = (1 - share) * sources[s].mesh.positions.row(edge(0)) +
                                     share * sources[s].mesh.positions.row(edge(1));
        double nearest = 1e300;
        for (const Eigen::Vector2i& hard : shared.hard_edges) {
          nearest = std::min(nearest, segment_distance(p, at.row(hard(0)), at.row(hard(1))));
        }
        EXPECT_LT(nearest, options.max_error * 4);  // the diagonals are 3.5 and 4.1
      }
    }
  }
}

TEST(Triangulate, KeepsTheBorderOfDisksOnTheBorder) {
  Mesh dome = test::grid(14, 14);
  for (int v = 0; v < dome.positions.rows(); ++v) {
    dome.positions(v, 2) =
        4 * std::exp(-(dome.positions.row(v).head(2).array() - 6.5).square().sum() / 12);
  }
  std::vector<SourceSurface> sources{surface("flat", test::grid(9, 9), {}),
                                     surface("dome", dome, {})};
  for (SourceSurface& source : sources) {
    const Eigen::RowVector3d size = source.mesh.positions.colwise().maxCoeff();
    for (const Eigen::Vector2d& at :
         {Eigen::Vector2d(0.3, 0.3), Eigen::Vector2d(0.7, 0.35), Eigen::Vector2d(0.4, 0.7)}) {
      double nearest = 1e300;
      SurfacePoint point;
      for (int f = 0; f < source.mesh.triangles.rows(); ++f) {
        Eigen::Vector2d middle = Eigen::Vector2d::Zero();
        for (int k = 0; k < 3; ++k) {
          middle += source.mesh.positions.row(source.mesh.triangles(f, k)).head(2).transpose() / 3;
        }
        const double away = (middle - at * size(0)).norm();
        if (away < nearest) point = {f, Eigen::Vector3d::Constant(1.0 / 3)};
        nearest = std::min(nearest, away);
      }
      source.landmark_names.push_back("point " + std::to_string(source.landmarks.size()));
      source.landmarks.push_back(point);
    }
  }
  RemeshOptions options;
  options.max_error = 0.005;
  options.target_edge_length = 0.1;
  const SharedTriangulation shared = triangulate(map_to_sphere(sources, {}), options, {});
  expect_shared(sources, shared, true);
  int border = 0;
  for (int v = 0; v < shared.connectivity.vertex_count; ++v) {
    if (!shared.on_boundary[static_cast<std::size_t>(v)]) continue;
    ++border;
    const Eigen::RowVector3d p = shared.geometries[0].row(v);  // the flat one: a square of side 8
    EXPECT_LT(std::min({p.x(), p.y(), 8 - p.x(), 8 - p.y()}), 1e-12);
  }
  EXPECT_GE(border, 8);
}

}  // namespace
}  // namespace morphbake
