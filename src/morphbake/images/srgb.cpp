#include "morphbake/images/srgb.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace morphbake {
namespace {

std::array<float, 256> decoding_table() {
  std::array<float, 256> table{};
  for (int i = 0; i < 256; ++i) {
    table[static_cast<std::size_t>(i)] = srgb_to_linear(static_cast<float>(i) / 255.0f);
  }
  return table;
}

}  // namespace

float srgb_to_linear(std::uint8_t value) {
  static const std::array<float, 256> table = decoding_table();
  return table[value];
}

float srgb_to_linear(float value) {
  return value <= 0.04045f ? value / 12.92f : std::pow((value + 0.055f) / 1.055f, 2.4f);
}

std::uint8_t linear_to_srgb(float linear) {
  if (!(linear > 0.0f)) return 0;
  const float x = std::min(linear, 1.0f);
  const float encoded = x <= 0.0031308f ? 12.92f * x : 1.055f * std::pow(x, 1.0f / 2.4f) - 0.055f;
  return static_cast<std::uint8_t>(encoded * 255.0f + 0.5f);
}

}  // namespace morphbake
