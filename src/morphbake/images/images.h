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

/// Of an encoded image. Its pixels are bounded by decode_image; while a file is read it is held
/// twice.
constexpr std::size_t kMostImageBytes = std::size_t{1} << 28;

/// Decodes PNG or JPEG bytes; alpha, orientation tags and colour profiles are ignored
/// (glTF 2.0, 3.8).
///
/// @param name  where the bytes come from, for the error message: a file, or "face.glb#/images/0"
/// @throws BakeError "image.unreadable" (neither PNG nor JPEG, damaged, cut short) or
///         "image.too-large" (more than 16384 pixels a side or 64 million in all), both before any
///         pixel memory is allocated where the header shows it
Image decode_image(std::string_view bytes, const std::string& name);

/// PNG bytes of `image`: no time stamp, the same for the same pixels.
std::string encode_png(const Image& image);

/// Writes an endlessly looping animated GIF to `file` (which the caller owns as a temporary file).
///
/// One palette serves the whole loop and the dither pattern stands still, so nothing flickers that
/// does not move.
/// @param frames  one or more pictures of one size, at most 65535 pixels a side
/// @param frames_per_second  above 0, at most 50 (players slow shorter delays down); the delays are
///         whole hundredths of a second that add up to the loop's length
/// @throws BakeError "output.unwritable"
void write_gif(const std::filesystem::path& file, const std::vector<Image>& frames,
               double frames_per_second);

/// All `frames` (one or more) in one picture, `columns` a row, scaled down to `cell_width`.
///
/// The gaps take the colour of the first frame's border. Cells are never scaled up.
Image contact_sheet(const std::vector<Image>& frames, int columns, int cell_width);

/// `image` scaled down to `width` x `height` (at most its own size) by an exact box filter on
/// linear light.
Image scale_down(const Image& image, int width, int height);

}  // namespace morphbake
