#include "morphbake/images/drawing.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace morphbake {
namespace {

constexpr Ink kBlack{{0, 0, 0}, 1};

int dark_pixels(const Image& image) {
  int count = 0;
  for (std::size_t i = 0; i < image.rgb.size(); i += 3) count += image.rgb[i] < 128;
  return count;
}

TEST(Drawing, WhatLiesOutsideIsCut) {
  Image image = blank_image(4, 4, {255, 255, 255});
  draw_ring(image, {-50, 2}, 0, 10, kBlack);
  draw_line(image, {-10, -10}, {-2, -5}, 1, kBlack);
  draw_text(image, "far away", {-200, 100}, 3, kBlack);
  EXPECT_EQ(dark_pixels(image), 0);
  draw_ring(image, {2, 2}, 0, 1000, kBlack);
  EXPECT_EQ(dark_pixels(image), 16);
  Image target = blank_image(3, 3, {255, 255, 255});
  paste(image, 2, -3, target);
  EXPECT_EQ(dark_pixels(target), 1);
  EXPECT_EQ(target.rgb[6], 0);
  paste(image, 9, 9, target);
  EXPECT_EQ(dark_pixels(target), 1);
}

TEST(Drawing, ADiscHasItsArea) {
  Image image = blank_image(64, 64, {255, 255, 255});
  draw_ring(image, {32, 32}, 0, 20, kBlack);
  EXPECT_NEAR(dark_pixels(image), M_PI * 400, 20);
  draw_ring(image, {32, 32}, 0, 30, {{255, 255, 255}, 1});
  draw_ring(image, {32, 32}, 10, 20, kBlack);
  EXPECT_NEAR(dark_pixels(image), M_PI * 300, 20);
}

TEST(Drawing, TextFillsItsBoxAndNoMore) {
  Image image = blank_image(40, 20, {255, 255, 255});
  draw_text(image, "H1", {2, 3}, 2, kBlack);
  const Eigen::Vector2i size = text_size("H1", 2);
  EXPECT_EQ(size, Eigen::Vector2i(22, 14));
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      const bool inside = x >= 2 && x < 2 + size.x() && y >= 3 && y < 3 + size.y();
      if (inside) continue;
      EXPECT_EQ(image.rgb[static_cast<std::size_t>(3 * (y * 40 + x))], 255);
    }
  }
  EXPECT_GT(dark_pixels(image), 60);
}

TEST(Drawing, EachLetterOfOtherAlphabetsIsOneMark) {
  EXPECT_EQ(text_size("größe", 1), text_size("gross", 1));
  Image known = blank_image(12, 10, {255, 255, 255}), unknown = known;
  draw_text(known, "?", {1, 1}, 1, kBlack);
  draw_text(unknown, "長", {1, 1}, 1, kBlack);
  EXPECT_EQ(known.rgb, unknown.rgb);
}

TEST(Drawing, TextThatIsTooLongLosesItsMiddle) {
  EXPECT_EQ(fitted_text("absolute.glb", text_size("absolute.glb", 2).x(), 2), "absolute.glb");
  EXPECT_EQ(fitted_text("absolute.glb", text_size("absolute.glb", 2).x() - 1, 2), "abso....glb");
  EXPECT_EQ(fitted_text("größe-länge", text_size("gr...ge", 1).x(), 1), "gr...ge");
  EXPECT_EQ(fitted_text("abcdef", text_size("a...", 1).x(), 1), "a...");
  EXPECT_EQ(fitted_text("abcdef", text_size("...", 1).x(), 1), "...");
  EXPECT_EQ(fitted_text("abcdef", text_size("...", 1).x() - 1, 1), "");
  EXPECT_EQ(fitted_text("", 0, 1), "");
}

}  // namespace
}  // namespace morphbake
