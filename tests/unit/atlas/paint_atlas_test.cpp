#include "morphbake/atlas/paint_atlas.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <cmath>
#include <random>

#include "morphbake/atlas/fill_gaps.h"
#include "morphbake/images/srgb.h"
#include "morphbake/mesh/closest_point.h"
#include "shapes/shapes.h"

namespace morphbake {
namespace {

/// A smooth colour of each place.
Eigen::Array3f analytic_colour(const Eigen::Vector3d& at) {
  return (0.5 + 0.4 * (2.0 * at.array()).sin()).cast<float>();
}

TexelColours colours_of(const Mesh& mesh) {
  return [&mesh](const std::vector<AtlasTexel>& texels) {
    std::vector<Eigen::Array3f> colours;
    for (const AtlasTexel& texel : texels) {
      colours.push_back(analytic_colour(position_of(mesh, texel.at)));
    }
    return colours;
  };
}

Eigen::Array3f texel_of(const Image& image, int x, int y) {
  const std::uint8_t* rgb = &image.rgb[static_cast<std::size_t>(3 * (y * image.width + x))];
  return {srgb_to_linear(rgb[0]), srgb_to_linear(rgb[1]), srgb_to_linear(rgb[2])};
}

Eigen::Array3f bilinear(const Image& image, const Eigen::RowVector2d& uv) {
  const double x = uv.x() * image.width - 0.5, y = uv.y() * image.height - 0.5;
  const int i = static_cast<int>(std::floor(x)), j = static_cast<int>(std::floor(y));
  const auto a = static_cast<float>(x - i), b = static_cast<float>(y - j);
  return (1 - b) * ((1 - a) * texel_of(image, i, j) + a * texel_of(image, i + 1, j)) +
         b * ((1 - a) * texel_of(image, i, j + 1) + a * texel_of(image, i + 1, j + 1));
}

/// The largest difference from the colour of the surface at random points of it, corners and edges
/// of triangles among them.
float largest_error(const Atlas& atlas, const Mesh& mesh, const Image& image) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> share(0, 1);
  float largest = 0;
  for (int f = 0; f < mesh.triangles.rows(); ++f) {
    for (int i = 0; i < 8; ++i) {
      Eigen::Vector3d weights(share(random), share(random), i < 4 ? 0 : share(random));
      if (i == 0) weights = Eigen::Vector3d(0, 0, 1);
      weights /= weights.sum();
      Eigen::RowVector2d uv(0, 0);
      for (int k = 0; k < 3; ++k) {
        uv += weights(k) * atlas.places.row(atlas.of_corner[static_cast<std::size_t>(3 * f + k)]);
      }
      const Eigen::Array3f wanted = analytic_colour(position_of(mesh, {f, weights}));
      largest = std::max(largest, (bilinear(image, uv) - wanted).abs().maxCoeff());
    }
  }
  return largest;
}

TEST(PaintAtlas, StopsWhenAsked) {
  const Mesh mesh = test::sphere(8, 10);
  const Atlas atlas = make_atlas(mesh, {}, {64, 1});
  Observer observer;
  observer.is_cancelled = [] { return true; };
  EXPECT_THROW(paint_atlas(atlas, mesh, colours_of(mesh), observer), Cancelled);
}

TEST(PaintAtlas, ShowsTheSurfacesColoursEverywhere) {
  for (const Mesh& mesh : {test::sphere(24, 32), test::torus(24, 40)}) {
    const Atlas atlas = make_atlas(mesh, {}, {512, 4});
    const Image image = paint_atlas(atlas, mesh, colours_of(mesh));
    // A texel is 1/60 of the radius; the colour changes by 0.8 a radius. A step of 8 bits is 0.01.
    EXPECT_LT(largest_error(atlas, mesh, image), 0.02F);
  }
}

TEST(PaintAtlas, TellsHowWideATexelIsOnTheSurface) {
  const Mesh mesh = test::grid(9, 9);
  const Atlas atlas = make_atlas(mesh, {}, {128, 4});
  double least = 1e9, most = 0;
  const tbb::global_control one_thread(tbb::global_control::max_allowed_parallelism, 1);
  paint_atlas(atlas, mesh, [&](const std::vector<AtlasTexel>& texels) {
    for (const AtlasTexel& texel : texels) {
      least = std::min(least, texel.width);
      most = std::max(most, texel.width);
    }
    return std::vector<Eigen::Array3f>(texels.size(), Eigen::Array3f::Zero());
  });
  const double width = 8.0 / std::sqrt(atlas.covered * 128 * 128);
  EXPECT_NEAR(least, width, 1e-3 * width);
  EXPECT_NEAR(most, width, 1e-3 * width);
}

TEST(PaintAtlas, HasNoForeignColourInAnyMipLevel) {
  const Mesh mesh = test::torus(24, 40);
  const Atlas atlas = make_atlas(mesh, {}, {512, 4});
  const Image image = paint_atlas(atlas, mesh, [](const std::vector<AtlasTexel>& texels) {
    return std::vector<Eigen::Array3f>(texels.size(), Eigen::Array3f(0.5F, 0.25F, 0.125F));
  });
  for (std::size_t i = 0; i < image.rgb.size(); ++i) {
    ASSERT_EQ(image.rgb[i], image.rgb[i % 3]) << i;
  }
}

TEST(PaintAtlas, IsTheSameOnAnyNumberOfThreads) {
  const Mesh mesh = test::torus(24, 40);
  const Atlas atlas = make_atlas(mesh, {}, {300, 4});
  const auto painted = [&](std::size_t threads) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    return paint_atlas(atlas, mesh, colours_of(mesh)).rgb;
  };
  EXPECT_EQ(painted(1), painted(2));
}

TEST(FillGaps, LeavesKnownPixelsAndGivesOthersWhatIsNear) {
  Image image{9, 8, std::vector<std::uint8_t>(3 * 9 * 8, 77)};
  std::vector<char> known(9 * 8, 0);
  const auto set = [&](std::size_t x, std::size_t y, std::uint8_t value) {
    known[y * 9 + x] = 1;
    for (std::size_t c = 0; c < 3; ++c) image.rgb[3 * (y * 9 + x) + c] = value;
  };
  set(0, 0, 200);
  set(7, 7, 20);
  fill_gaps(image, known);
  EXPECT_EQ(image.rgb[0], 200);
  EXPECT_EQ(image.rgb[3 * 1], 200);
  EXPECT_EQ(image.rgb[3 * (7 * 9 + 7)], 20);
  EXPECT_EQ(image.rgb[3 * (6 * 9 + 6)], 20);
  for (const std::uint8_t value : image.rgb) {
    EXPECT_GE(value, 20);
    EXPECT_LE(value, 200);
  }
}

TEST(FillGaps, LeavesAPictureWithoutAnyKnownPixelBlack) {
  Image image{3, 2, std::vector<std::uint8_t>(18, 77)};
  fill_gaps(image, std::vector<char>(6, 0));
  EXPECT_THAT(image.rgb, testing::Each(0));
}

}  // namespace
}  // namespace morphbake
