#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace morphbake {

/// GIF's LZW code stream for 8-bit `indices`: codes of 9 to 12 bits, low bits first, starting with
/// a clear code and closed by an end code.
///
/// @see GIF89a, appendix F. The result is not yet cut into sub-blocks.
std::string lzw_compress(const std::vector<std::uint8_t>& indices);

}  // namespace morphbake
