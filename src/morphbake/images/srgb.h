#pragma once

#include <cstdint>

namespace morphbake {

/// Linear light of an 8-bit sRGB value, 0 to 1 (IEC 61966-2-1).
float srgb_to_linear(std::uint8_t value);

/// Linear light of an sRGB value in 0..1.
float srgb_to_linear(float value);

/// Nearest 8-bit sRGB value of `linear`, which is clamped to 0..1 (NaN gives 0).
std::uint8_t linear_to_srgb(float linear);

}  // namespace morphbake
