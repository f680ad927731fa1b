#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <string>
#include <string_view>

#include "morphbake/images/images.h"

namespace morphbake {

/// 8-bit sRGB and how much it covers, 0 to 1.
struct Ink {
  std::array<std::uint8_t, 3> colour{};
  float opacity = 1;
};

/// A picture of one colour.
Image blank_image(int width, int height, const std::array<std::uint8_t, 3>& colour);

/// Puts `image` on `target` with its top left corner at (left, top), cut at the borders.
void paste(const Image& image, int left, int top, Image& target);

/// Fills a ring with smooth edges; what lies outside of the picture is cut.
///
/// @param centre  pixels from the top left corner; pixel (0, 0) has its middle at (0.5, 0.5)
/// @param inner   radius in pixels, 0 for a disc
void draw_ring(Image& image, const Eigen::Vector2f& centre, float inner, float outer,
               const Ink& ink);

/// Draws a line with round ends and smooth edges.
///
/// @param width  pixels
void draw_line(Image& image, const Eigen::Vector2f& from, const Eigen::Vector2f& to, float width,
               const Ink& ink);

/// Size of a text in pixels: letters of 5 by 7, one apart, times `scale`. What is no printable
/// ASCII counts one letter a code point and is drawn as "?".
Eigen::Vector2i text_size(std::string_view text, int scale);

/// `text` as it is where that is at most `width` pixels wide, else with "..." for as little of its
/// middle as need be: what tells names apart stands at their ends.
///
/// @return  empty when there is not even room for "..."
std::string fitted_text(const std::string& text, int width, int scale);

/// Draws a text.
///
/// @param corner  its top left one, in pixels
void draw_text(Image& image, std::string_view text, const Eigen::Vector2i& corner, int scale,
               const Ink& ink);

}  // namespace morphbake
