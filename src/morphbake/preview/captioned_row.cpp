#include "morphbake/preview/captioned_row.h"

#include <algorithm>
#include <array>

#include "morphbake/images/drawing.h"

namespace morphbake {
namespace {

constexpr std::array<std::uint8_t, 3> kPaper{246, 245, 243};
constexpr std::array<std::uint8_t, 3> kText{40, 40, 44};
constexpr int kPixelsALetterDot = 150;  ///< width of a picture for each pixel of a letter's dots

}  // namespace

Image captioned_row(const std::vector<Image>& pictures, const std::vector<std::string>& captions,
                    const std::string& note) {
  const int width = pictures.front().width, height = pictures.front().height;
  const int scale = std::max(1, width / kPixelsALetterDot);
  const int margin = 3 * scale;
  const int strip = text_size("", scale).y() + 2 * margin;
  const int gap = scale;
  const int count = static_cast<int>(pictures.size());
  Image row = blank_image(count * (width + gap) - gap, strip + height, kPaper);
  const Ink ink{kText, 1};
  for (int k = 0; k < count; ++k) {
    const int left = k * (width + gap);
    paste(pictures[static_cast<std::size_t>(k)], left, strip, row);
    int room = width - 2 * margin;
    const int note_width = text_size(note, scale).x();
    if (k == count - 1 && room >= 3 * note_width) {
      draw_text(row, note, {left + margin + room - note_width, margin}, scale, ink);
      room -= note_width + 2 * margin;
    }
    draw_text(row, fitted_text(captions[static_cast<std::size_t>(k)], room, scale),
              {left + margin, margin}, scale, ink);
  }
  return row;
}

}  // namespace morphbake
