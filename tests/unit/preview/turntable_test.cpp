#include "morphbake/preview/turntable.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>

#include "morphbake/diagnostics/problem.h"
#include "tests/unit/preview/subjects.h"

namespace morphbake {
namespace {

std::vector<std::string> codes_of(const AnimatedMesh& mesh, const TurntableOptions& options) {
  std::vector<std::string> codes;
  try {
    render_turntable(mesh, options, {});
  } catch (const BakeError& error) {
    for (const Problem& problem : error.problems()) codes.push_back(problem.code);
  }
  return codes;
}

/// Mean brightness of a square of 2 n + 1 pixels around a place given in shares of the picture.
double brightness(const Image& image, double x, double y, int n = 2) {
  const int column = static_cast<int>(x * image.width), row = static_cast<int>(y * image.height);
  double sum = 0;
  for (int dy = -n; dy <= n; ++dy) {
    for (int dx = -n; dx <= n; ++dx) {
      const std::size_t at = (std::size_t(row + dy) * image.width + column + dx) * 3;
      sum += image.rgb[at] + image.rgb[at + 1] + image.rgb[at + 2];
    }
  }
  return sum / (3.0 * (2 * n + 1) * (2 * n + 1));
}

double mean_difference(const Image& a, const Image& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.rgb.size(); ++i) sum += std::abs(a.rgb[i] - b.rgb[i]);
  return sum / static_cast<double>(a.rgb.size());
}

TEST(Turntable, NamesEveryBadOption) {
  TurntableOptions options;
  options.width = 8;
  options.samples = 0;
  options.fill = std::nan("");
  options.background[1] = 2;
  EXPECT_EQ(codes_of(growing_column(), options), std::vector<std::string>(4, "preview.bad-option"));
}

TEST(Turntable, RefusesVerticesThatAreNotFinite) {
  AnimatedMesh mesh = growing_column();
  mesh.primitives[0].target_positions[0](7, 1) = std::numeric_limits<float>::infinity();
  EXPECT_EQ(codes_of(mesh, small_options()), std::vector<std::string>{"preview.not-finite"});
}

TEST(Turntable, WarnsOfADamagedTextureAndGoesOnWithoutIt) {
  AnimatedMesh mesh = growing_column();
  mesh.images = {"no image"};
  mesh.primitives[0].image = 0;
  mesh.primitives[0].texture_coordinates = Float2s::Zero(mesh.primitives[0].positions.rows(), 2);
  std::vector<Problem> told;
  Observer observer;
  observer.on_problem = [&](const Problem& problem) { told.push_back(problem); };
  const std::vector<Image> pictures = render_turntable(mesh, small_options(), observer);
  ASSERT_EQ(told.size(), 1U);
  EXPECT_EQ(told[0].code, "image.unreadable");
  EXPECT_EQ(told[0].severity, Severity::Warning);
  mesh.primitives[0].image = -1;
  mesh.primitives[0].texture_coordinates.resize(0, 2);
  EXPECT_EQ(pictures.size(), render_turntable(mesh, small_options(), {}).size());
}

TEST(Turntable, StopsWhenItIsCancelled) {
  Observer observer;
  int pictures = -1;
  observer.on_progress = [&](const Progress&) { ++pictures; };
  observer.is_cancelled = [&] { return pictures == 2; };
  EXPECT_THROW(render_turntable(growing_column(), small_options(), observer), Cancelled);
  EXPECT_EQ(pictures, 2);
}

TEST(Turntable, ShowsOnlyTheBackdropOfNothing) {
  TurntableOptions options = small_options();
  options.frames = 2;
  const std::vector<Image> empty = render_turntable(AnimatedMesh{}, options, {});
  AnimatedPrimitive point = sphere({3, 4, 5});
  point.positions.rowwise() = Eigen::RowVector3f(3, 4, 5);
  const std::vector<Image> collapsed = render_turntable(still(point), options, {});
  ASSERT_EQ(empty.size(), 2u);
  EXPECT_EQ(empty[0].rgb, empty[1].rgb);
  EXPECT_EQ(empty[0].rgb, collapsed[0].rgb);
}

TEST(Turntable, SurvivesDegenerateTriangles) {
  AnimatedPrimitive primitive = sphere({0, 0, 0});
  for (int f = 0; f < 100; ++f) primitive.triangles.row(f).setConstant(f);
  primitive.normals.setZero();
  EXPECT_EQ(render_turntable(still(primitive), small_options(), {}).size(), 8u);
}

TEST(Turntable, IsTheSameOnAnyNumberOfThreads) {
  TurntableOptions options = small_options();
  options.frames = 3;
  options.threads = 1;
  const std::vector<Image> one = render_turntable(growing_column(), options, {});
  for (const int threads : {2, 5, 0}) {
    options.threads = threads;
    const std::vector<Image> several = render_turntable(growing_column(), options, {});
    for (std::size_t i = 0; i < one.size(); ++i) EXPECT_EQ(one[i].rgb, several[i].rgb) << threads;
  }
}

TEST(Turntable, ClosesItsLoop) {
  TurntableOptions options = small_options();
  options.frames = 16;
  const std::vector<Image> pictures = render_turntable(growing_column(), options, {});
  double largest = 0;
  for (std::size_t i = 1; i < pictures.size(); ++i) {
    largest = std::max(largest, mean_difference(pictures[i - 1], pictures[i]));
  }
  EXPECT_GT(largest, 0.5);
  EXPECT_LE(mean_difference(pictures.back(), pictures.front()), 1.1 * largest);
}

TEST(Turntable, LightsTheSideOfTheKeyLight) {
  TurntableOptions options = small_options();
  options.frames = 1;
  const Image image = render_turntable(still(sphere({0, 0, 0})), options, {})[0];
  // The soft box stands above to the left of the camera.
  EXPECT_GT(brightness(image, 0.35, 0.32), brightness(image, 0.65, 0.68) + 40);
}

TEST(Turntable, CastsAShadowOnTheFloor) {
  TurntableOptions options = small_options();
  options.frames = 1;
  const Image subject = render_turntable(still(sphere({0, 0, 0})), options, {})[0];
  const Image nothing = render_turntable(AnimatedMesh{}, options, {})[0];
  // To the right of the contact, and far to the left.
  EXPECT_LT(brightness(subject, 0.68, 0.86), brightness(nothing, 0.68, 0.86) - 20);
  EXPECT_NEAR(brightness(subject, 0.05, 0.6), brightness(nothing, 0.05, 0.6), 4);
}

TEST(Turntable, IsSmooth) {
  // Flat ground in a soft shadow: neighbours must not differ by noise.
  TurntableOptions options = small_options();
  options.width = options.height = 256;
  options.frames = 1;
  options.samples = TurntableOptions{}.samples;
  const Image image = render_turntable(still(sphere({0, 0, 0})), options, {})[0];
  double noise = 0;
  int count = 0;
  for (int y = 215; y < 235; ++y) {
    for (int x = 40; x < 216; ++x, ++count) {
      const auto red = [&](int dx) { return int(image.rgb[(std::size_t(y) * 256 + x + dx) * 3]); };
      noise += std::abs(red(-1) - 2 * red(0) + red(1));
    }
  }
  EXPECT_LT(noise / count, 1.0);  // second difference in 8-bit steps
}

TEST(Turntable, KeepsColoursAndGivesClayToWhite) {
  TurntableOptions options = small_options();
  options.frames = 1;
  AnimatedMesh mesh = still(sphere({0, 0, 0}));
  const Image clay = render_turntable(mesh, options, {})[0];
  mesh.primitives[0].base_colour = {0.1f, 0.1f, 0.7f};
  const Image blue = render_turntable(mesh, options, {})[0];
  const std::size_t middle = (48 * 96 + 48) * 3;
  EXPECT_GT(clay.rgb[middle], clay.rgb[middle + 2]);
  EXPECT_LT(clay.rgb[middle], 235);
  EXPECT_GT(blue.rgb[middle + 2], blue.rgb[middle] + 60);
}

TEST(Turntable, IsTheSameFarFromTheOrigin) {
  TurntableOptions options = small_options();
  options.frames = 1;
  AnimatedMesh mesh = growing_column();
  const Image here = render_turntable(mesh, options, {})[0];
  mesh.to_scene.topLeftCorner<3, 3>() *= 1e-3;
  mesh.to_scene.topRightCorner<3, 1>() << 1e5, -2e5, 3e5;
  EXPECT_LT(mean_difference(here, render_turntable(mesh, options, {})[0]), 0.05);
}

TEST(Turntable, TakesAHundredThousandTriangles) {
  TurntableOptions options = small_options();
  options.frames = 2;
  AnimatedMesh mesh = still(sphere({0, 0, 0}, 400, 125));
  ASSERT_EQ(mesh.primitives[0].triangles.rows(), 100000);
  EXPECT_EQ(render_turntable(mesh, options, {}).size(), 2u);
}

TEST(SideBySide, ShowsEqualMorphsAlike) {
  AnimatedMesh elsewhere = growing_column();
  elsewhere.to_scene.topRightCorner<3, 1>() << 10, -20, 30;
  const TurntableOptions options = small_options();
  const std::vector<Image> rows = render_side_by_side(
      {{"a.glb", "a.glb", growing_column()}, {"b.glb", "b.glb", elsewhere}}, options, {});
  ASSERT_EQ(rows.size(), 8U);
  for (const Image& row : rows) {
    ASSERT_GE(row.width, 2 * options.width);
    const int strip = row.height - options.height;
    double difference = 0;
    for (int y = strip; y < row.height; ++y) {
      for (int x = 0; x < options.width; ++x) {
        const auto at = [&](int column) {
          return int(row.rgb[3 * (std::size_t(y) * row.width + column)]);
        };
        difference += std::abs(at(x) - at(row.width - options.width + x));
      }
    }
    EXPECT_LT(difference / (options.width * options.height), 0.05);
  }
}

TEST(SideBySide, StopsWhenItIsCancelled) {
  Observer observer;
  int pictures = -1;
  observer.on_progress = [&](const Progress& progress) {
    ++pictures;
    EXPECT_EQ(progress.total, 16);
  };
  observer.is_cancelled = [&] { return pictures == 3; };
  EXPECT_THROW(render_side_by_side(
                   {{"a.glb", "a.glb", growing_column()}, {"b.glb", "b.glb", growing_column()}},
                   small_options(), observer),
               Cancelled);
}

}  // namespace
}  // namespace morphbake
