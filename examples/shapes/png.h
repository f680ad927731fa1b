// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace shapes {

/// A square PNG of 8 bits a channel.
///
/// @param rgb  3 size^2 values, row by row from the top
std::string png(int size, const std::vector<std::uint8_t>& rgb);

}  // namespace shapes
