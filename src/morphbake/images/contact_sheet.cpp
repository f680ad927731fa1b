#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>

#include "morphbake/images/drawing.h"
#include "morphbake/images/images.h"
#include "morphbake/images/srgb.h"

namespace morphbake {
namespace {

/// Mean of the four corners: the studio's backdrop at the edge of the picture.
std::array<std::uint8_t, 3> border_colour(const Image& image) {
  const std::size_t last_column = static_cast<std::size_t>(image.width) - 1;
  const std::size_t last_row = static_cast<std::size_t>(image.height) - 1;
  std::array<std::uint8_t, 3> colour{};
  for (std::size_t k = 0; k < 3; ++k) {
    float sum = 0;
    for (const std::size_t row : {std::size_t{0}, last_row}) {
      for (const std::size_t column : {std::size_t{0}, last_column}) {
        const std::size_t at = (row * static_cast<std::size_t>(image.width) + column) * 3 + k;
        sum += srgb_to_linear(image.rgb[at]);
      }
    }
    colour[k] = linear_to_srgb(sum / 4);
  }
  return colour;
}

}  // namespace

Image contact_sheet(const std::vector<Image>& frames, int columns, int cell_width) {
  assert(!frames.empty() && columns >= 1 && cell_width >= 1);
  const Image& first = frames.front();
  const int width = std::min(cell_width, first.width);
  const int height = std::max(
      1, static_cast<int>(std::lround(static_cast<double>(first.height) * width / first.width)));
  const int gap = std::max(1, width / 48);
  const int count = static_cast<int>(frames.size());
  const int across = std::min(columns, count);
  const int down = (count + across - 1) / across;
  Image sheet =
      blank_image(across * (width + gap) + gap, down * (height + gap) + gap, border_colour(first));
  for (int i = 0; i < count; ++i) {
    const Image cell = scale_down(frames[static_cast<std::size_t>(i)], width, height);
    paste(cell, gap + (i % across) * (width + gap), gap + (i / across) * (height + gap), sheet);
  }
  return sheet;
}

}  // namespace morphbake
