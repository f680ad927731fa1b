#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace morphbake {

/// 8-bit sRGB picture, row by row from the top.
struct Image {
  int width = 0;
  int height = 0;
  std::vector<std::uint8_t> rgb;  ///< width * height * 3
};

/// Decodes PNG or JPEG bytes; alpha is dropped.
///
/// @param name  where the bytes come from, for the error message
/// @throws BakeError "image.unreadable", "image.too-large" (more than 16384 pixels a side), before any
///         pixel memory is allocated
Image decode_image(std::string_view bytes, const std::string& name);

/// PNG bytes of `image`: no time stamp, the same for the same pixels.
std::string encode_png(const Image& image);

/// Writes an endlessly looping animated GIF to `file` (which the caller owns as a temporary file).
///
/// @param frames  one or more pictures of one size
/// @throws BakeError "output.unwritable"
void write_gif(const std::filesystem::path& file, const std::vector<Image>& frames,
               double frames_per_second);

/// All `frames` in one picture, `columns` a row, scaled down to `cell_width`.
Image contact_sheet(const std::vector<Image>& frames, int columns, int cell_width);

}  // namespace morphbake
