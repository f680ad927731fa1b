#pragma once

#include <cstdint>
#include <string>

#include "morphbake/images/images.h"

namespace morphbake {

/// Pixels of a fixed pseudo-random sequence (Numerical Recipes' generator).
inline Image coloured_noise(int width, int height) {
  Image image{width, height, {}};
  std::uint32_t state = 1;
  for (int i = 0; i < width * height * 3; ++i) {
    state = state * 1664525u + 1013904223u;
    image.rgb.push_back(static_cast<std::uint8_t>(state >> 24));
  }
  return image;
}

inline Image plain(int width, int height, std::uint8_t r, std::uint8_t g, std::uint8_t b) {
  Image image{width, height, {}};
  for (int i = 0; i < width * height; ++i) image.rgb.insert(image.rgb.end(), {r, g, b});
  return image;
}

/// The smallest baseline JPEG: 8 x 8 pixels of grey 128, one component, one code a Huffman table.
inline std::string grey_jpeg() {
  using namespace std::string_literals;
  const std::string table = "\x01"s + std::string(16, '\0');  // one code of one bit, for symbol 0
  return "\xff\xd8\xff\xdb\x00\x43\x00"s + std::string(64, '\1') +
         "\xff\xc0\x00\x0b\x08\x00\x08\x00\x08\x01\x01\x11\x00"s + "\xff\xc4\x00\x14\x00"s + table +
         "\xff\xc4\x00\x14\x10"s + table + "\xff\xda\x00\x08\x01\x01\x00\x00\x3f\x00\x3f\xff\xd9"s;
}

}  // namespace morphbake
