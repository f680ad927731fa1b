#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <Eigen/Geometry>
#include <cmath>
#include <map>
#include <set>
#include <string>

#include "morphbake/atlas/atlas.h"
#include "morphbake/mesh/adjacency.h"
#include "morphbake/mesh/measures.h"
#include "shapes/shapes.h"

namespace morphbake {
namespace {

struct Named {
  std::string name;
  Mesh mesh;
  std::vector<Eigen::Vector2i> hard_edges;
};

/// Edges at which two triangles meet at more than 40 degrees.
std::vector<Eigen::Vector2i> sharp_edges(const Mesh& mesh) {
  std::map<std::pair<int, int>, Eigen::RowVector3d> normals;
  std::vector<Eigen::Vector2i> sharp;
  for (int f = 0; f < mesh.triangles.rows(); ++f) {
    const auto at = [&](int k) -> Eigen::RowVector3d {
      return mesh.positions.row(mesh.triangles(f, k % 3));
    };
    const Eigen::RowVector3d normal = (at(1) - at(0)).cross(at(2) - at(0)).normalized();
    for (int k = 0; k < 3; ++k) {
      const auto [low, high] = std::minmax({mesh.triangles(f, k), mesh.triangles(f, (k + 1) % 3)});
      const auto [entry, is_new] = normals.try_emplace({low, high}, normal);
      if (!is_new && entry->second.dot(normal) < std::cos(0.7)) sharp.emplace_back(low, high);
    }
  }
  return sharp;
}

Mesh bumpy_sphere() {
  Mesh mesh = test::sphere(40, 60);
  mesh.positions = test::bent(mesh.positions, 0.6, 7);
  return mesh;
}

std::vector<Named> meshes() {
  const Mesh bar = test::bar(4);
  return {{"tetrahedron", test::tetrahedron(), {}},
          {"sphere", test::sphere(24, 32), {}},
          {"torus", test::torus(24, 40), {}},
          {"grid", test::grid(9, 7), {}},
          {"bar", bar, sharp_edges(bar)},
          {"bumpy sphere", bumpy_sphere(), {}},
          {"two pieces", test::joined(test::sphere(8, 10), test::torus(8, 12)), {}}};
}

/// Twice the area of a triangle on the picture, in texels; positive when it is seen from outside as
/// it is drawn.
double twice_area(const Eigen::Matrix<double, 3, 2>& corners) {
  const Eigen::RowVector2d a = corners.row(1) - corners.row(0);
  const Eigen::RowVector2d b = corners.row(2) - corners.row(0);
  return a.y() * b.x() - a.x() * b.y();
}

Eigen::Matrix<double, 3, 2> texels_of(const Atlas& atlas, int f) {
  Eigen::Matrix<double, 3, 2> corners;
  for (int k = 0; k < 3; ++k) {
    corners.row(k) =
        atlas.places.row(atlas.of_corner[static_cast<std::size_t>(3 * f + k)]) * atlas.size;
  }
  return corners;
}

/// Whether `place` lies inside; of two triangles with a common edge it is in one at most.
bool is_inside(const Eigen::Matrix<double, 3, 2>& corners, const Eigen::RowVector2d& place) {
  for (int k = 0; k < 3; ++k) {
    const Eigen::RowVector2d a = corners.row(k) - place, b = corners.row((k + 1) % 3) - place;
    if (!(a.y() * b.x() - a.x() * b.y() > 0)) return false;
  }
  return true;
}

/// The triangle over the middle of each sample, `fine` samples a texel's side; -1 for none. What
/// lies over another adds to `overlaps`.
std::vector<int> rasterised(const Atlas& atlas, int fine, int& overlaps) {
  const int side = atlas.size * fine;
  std::vector<int> triangle(static_cast<std::size_t>(side) * static_cast<std::size_t>(side), -1);
  for (int f = 0; f < static_cast<int>(atlas.chart.size()); ++f) {
    const Eigen::Matrix<double, 3, 2> corners = texels_of(atlas, f) * fine;
    const Eigen::RowVector2d low = corners.colwise().minCoeff();
    const Eigen::RowVector2d high = corners.colwise().maxCoeff();
    for (int y = static_cast<int>(low.y()); y <= static_cast<int>(high.y()); ++y) {
      for (int x = static_cast<int>(low.x()); x <= static_cast<int>(high.x()); ++x) {
        if (!is_inside(corners, {x + 0.5, y + 0.5})) continue;
        int& here = triangle[static_cast<std::size_t>(y * side + x)];
        if (here >= 0) ++overlaps;
        here = f;
      }
    }
  }
  return triangle;
}

TEST(Atlas, ThatHasNoRoomForItsChartsIsRefused) {
  const Mesh many = [] {
    Mesh mesh = test::tetrahedron();
    for (int i = 0; i < 5; ++i) mesh = test::joined(mesh, mesh);
    return mesh;
  }();
  try {
    make_atlas(many, {}, {64, 16});
    FAIL() << "no error";
  } catch (const BakeError& error) {
    EXPECT_EQ(error.problems().front().code, "connectivity.texture-too-small");
  }
}

TEST(Atlas, StopsWhenAsked) {
  Observer observer;
  observer.is_cancelled = [] { return true; };
  EXPECT_THROW(make_atlas(test::sphere(24, 32), {}, {}, observer), Cancelled);
}

TEST(Atlas, HasEachTriangleOnceUnturnedAndWithinTheSquare) {
  for (const Named& named : meshes()) {
    SCOPED_TRACE(named.name);
    const Atlas atlas = make_atlas(named.mesh, named.hard_edges, {256, 3});
    ASSERT_EQ(atlas.chart.size(), static_cast<std::size_t>(named.mesh.triangles.rows()));
    ASSERT_EQ(atlas.of_corner.size(), 3 * atlas.chart.size());
    EXPECT_GE(atlas.places.minCoeff(), 3.0 / 256);
    EXPECT_LE(atlas.places.maxCoeff(), 1 - 3.0 / 256);
    for (int f = 0; f < named.mesh.triangles.rows(); ++f) {
      EXPECT_GT(twice_area(texels_of(atlas, f)), 0) << f;
    }
    const std::set<int> charts(atlas.chart.begin(), atlas.chart.end());
    EXPECT_EQ(static_cast<int>(charts.size()), atlas.chart_count);
  }
}

TEST(Atlas, GivesAVertexOnePlaceInEachOfItsCharts) {
  const Mesh mesh = test::torus(24, 40);
  const Atlas atlas = make_atlas(mesh, {}, {256, 3});
  std::map<std::pair<int, int>, int> place;
  for (std::size_t c = 0; c < atlas.of_corner.size(); ++c) {
    const std::pair key{atlas.chart[c / 3], mesh.triangles.data()[c]};
    EXPECT_EQ(place.try_emplace(key, atlas.of_corner[c]).first->second, atlas.of_corner[c]);
  }
  EXPECT_EQ(place.size(), static_cast<std::size_t>(atlas.places.rows()));
}

TEST(Atlas, HasNoTriangleOverAnother) {
  for (const Named& named : meshes()) {
    SCOPED_TRACE(named.name);
    const Atlas atlas = make_atlas(named.mesh, named.hard_edges, {256, 3});
    int overlaps = 0;
    const std::vector<int> triangle = rasterised(atlas, 4, overlaps);
    EXPECT_EQ(overlaps, 0);
    const auto covered =
        std::count_if(triangle.begin(), triangle.end(), [](int f) { return f >= 0; });
    EXPECT_NEAR(atlas.covered, static_cast<double>(covered) / (1024.0 * 1024.0), 0.002);
  }
}

TEST(Atlas, KeepsChartsApartByTwiceThePadding) {
  const int padding = 4, size = 256;
  for (const Named& named : meshes()) {
    SCOPED_TRACE(named.name);
    const Atlas atlas = make_atlas(named.mesh, named.hard_edges, {size, padding});
    int overlaps = 0;
    const std::vector<int> triangle = rasterised(atlas, 1, overlaps);
    const auto chart_at = [&](int x, int y) {
      const int f = triangle[static_cast<std::size_t>(y * size + x)];
      return f < 0 ? -1 : atlas.chart[static_cast<std::size_t>(f)];
    };
    int close = 0;
    for (int y = 0; y < size; ++y) {
      for (int x = 0; x < size; ++x) {
        if (chart_at(x, y) < 0) continue;
        for (int j = y; j < std::min(size, y + 2 * padding); ++j) {
          for (int i = std::max(0, x - 2 * padding + 1); i < std::min(size, x + 2 * padding); ++i) {
            if (chart_at(i, j) >= 0 && chart_at(i, j) != chart_at(x, y)) ++close;
          }
        }
      }
    }
    EXPECT_EQ(close, 0);
  }
}

TEST(Atlas, GivesTheSurfaceOneNumberOfTexelsALength) {
  for (const Named& named : meshes()) {
    SCOPED_TRACE(named.name);
    const Atlas atlas = make_atlas(named.mesh, named.hard_edges, {512, 2});
    std::map<int, Eigen::Vector2d> areas;  // chart -> on the picture, on the surface
    double bad = 0, all = 0, texels = 0;
    for (int f = 0; f < named.mesh.triangles.rows(); ++f) {
      const auto at = [&](int k) -> Eigen::RowVector3d {
        return named.mesh.positions.row(named.mesh.triangles(f, k));
      };
      const double area = (at(1) - at(0)).cross(at(2) - at(0)).norm();
      areas.try_emplace(atlas.chart[static_cast<std::size_t>(f)], Eigen::Vector2d::Zero())
          .first->second += Eigen::Vector2d(twice_area(texels_of(atlas, f)), area);
      all += area;
      texels += twice_area(texels_of(atlas, f));
    }
    for (const auto& [chart, area] : areas) {
      EXPECT_NEAR(area(0) / area(1) / (texels / all), 1, 1e-9) << chart;
    }
    for (int f = 0; f < named.mesh.triangles.rows(); ++f) {
      const auto at = [&](int k) -> Eigen::RowVector3d {
        return named.mesh.positions.row(named.mesh.triangles(f, k));
      };
      const double area = (at(1) - at(0)).cross(at(2) - at(0)).norm();
      const double ratio = twice_area(texels_of(atlas, f)) / area / (texels / all);
      if (ratio < 0.5 || ratio > 2) bad += area;
    }
    EXPECT_LE(bad, 0.02 * all);
  }
}

TEST(Atlas, HidesSeamsAtHardEdges) {
  const Mesh bar = test::bar(4);
  const std::vector<Eigen::Vector2i> sharp = sharp_edges(bar);
  ASSERT_EQ(sharp.size(), 8U * 4 + 4U * 20);  // the edges of a bar of 4 by 4 by 20 cells
  const Atlas atlas = make_atlas(bar, sharp, {256, 2});
  std::map<std::pair<int, int>, int> chart;
  int seams = 0;
  for (std::size_t c = 0; c < atlas.of_corner.size(); ++c) {
    const int* corners = bar.triangles.data() + c / 3 * 3;
    const auto [low, high] = std::minmax(corners[c % 3], corners[(c + 1) % 3]);
    const int mine = atlas.chart[c / 3];
    if (chart.try_emplace({low, high}, mine).first->second == mine) continue;
    ++seams;
    EXPECT_THAT(sharp, testing::Contains(Eigen::Vector2i(low, high)));
  }
  EXPECT_GT(seams, 0);
}

TEST(Atlas, OfAFlatSheetIsOneChart) {
  const Atlas atlas = make_atlas(test::grid(9, 9), {}, {128, 4});
  EXPECT_EQ(atlas.chart_count, 1);
  EXPECT_NEAR(atlas.covered, 120.0 * 120 / (128 * 128), 0.02);
}

TEST(Atlas, FillsMostOfTheSquare) {
  for (const Named& named : meshes()) {
    EXPECT_GT(make_atlas(named.mesh, named.hard_edges, {1024, 4}).covered, 0.5) << named.name;
  }
}

TEST(Atlas, IsTheSameOnAnyNumberOfThreads) {
  const Mesh mesh = bumpy_sphere();
  const auto made = [&](std::size_t threads) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    return make_atlas(mesh, {}, {512, 4});
  };
  const Atlas one = made(1), two = made(2);
  EXPECT_EQ(one.chart, two.chart);
  EXPECT_EQ(one.places, two.places);
}

}  // namespace
}  // namespace morphbake
