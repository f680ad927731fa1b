#pragma once

#include <array>
#include <cstdint>
#include <unordered_map>
#include <vector>

#include "morphbake/images/images.h"

namespace morphbake {

using Colour8 = std::array<std::uint8_t, 3>;  ///< 8-bit sRGB

/// At most `size` colours that stand for all pixels of all `frames`: variance-based median cut on a
/// histogram with 6 bits a channel, then k-means.
///
/// @param size  1 to 256
/// @return      1 to `size` colours; the frames' own when they hold so few
/// @cost        O(pixels) + O(distinct colours * size)
std::vector<Colour8> common_palette(const std::vector<Image>& frames, int size);

/// Maps colours to indices of a palette with a dither that depends on the pixel's place alone.
///
/// A colour between two entries is shown by both, mixed in a fixed pattern: a still gradient stays
/// still, where error diffusion would boil from frame to frame.
class DitheredPalette {
 public:
  explicit DitheredPalette(std::vector<Colour8> colours);

  /// Indices of `image`, row by row.
  std::vector<std::uint8_t> indices(const Image& image);

 private:
  struct Mix {
    std::uint8_t near = 0;
    std::uint8_t far = 0;
    std::uint8_t share = 0;  ///< of `far`, in 1/64
  };

  std::uint8_t nearest(const std::array<int, 3>& colour) const;
  Mix mix_of(const Colour8& colour) const;

  std::vector<Colour8> colours_;
  std::unordered_map<std::uint32_t, Mix> mixes_;  ///< by packed colour: frames repeat their colours
};

}  // namespace morphbake
