#pragma once

#include <optional>
#include <string_view>

namespace morphbake {

enum class ImageFormat { Png, Jpeg };

/// What the first bytes of an encoded image promise.
struct ImageHeader {
  ImageFormat format = ImageFormat::Png;
  int width = 0;   ///< pixels, as written; may be 0 or huge in a damaged file
  int height = 0;  ///< pixels
};

/// Reads size and format without decoding: allocates nothing and never reads beyond `bytes`.
///
/// @return nothing when `bytes` is neither PNG nor JPEG or ends before the size
std::optional<ImageHeader> read_image_header(std::string_view bytes);

/// Whether the chunks of a PNG (with a valid signature) follow each other up to IEND; their check
/// sums are not looked at.
bool has_whole_png_chunks(std::string_view bytes);

/// Whether a PNG's bytes can unpack to as many pixels as its header claims: deflate packs at most
/// 1032 bytes into one.
bool can_hold_png_pixels(std::string_view bytes);

}  // namespace morphbake
