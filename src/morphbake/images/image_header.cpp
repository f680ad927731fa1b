#include "morphbake/images/image_header.h"

#include <cstddef>
#include <cstdint>

namespace morphbake {
namespace {

unsigned byte_at(std::string_view bytes, std::size_t at) {
  return static_cast<unsigned char>(bytes[at]);
}

unsigned big_endian_16(std::string_view bytes, std::size_t at) {
  return byte_at(bytes, at) << 8 | byte_at(bytes, at + 1);
}

std::uint32_t big_endian_32(std::string_view bytes, std::size_t at) {
  return big_endian_16(bytes, at) << 16 | big_endian_16(bytes, at + 2);
}

/// A PNG side is at most 2^31 - 1; a damaged one above that is still too large as an int.
int big_endian_side(std::string_view bytes, std::size_t at) {
  const std::uint32_t side = big_endian_32(bytes, at);
  return static_cast<int>(side & 0x7fffffffu) | (side >> 31 != 0 ? 0x7fffffff : 0);
}

std::optional<ImageHeader> png_header(std::string_view bytes) {
  // The signature, then IHDR's length and name, then width and height.
  if (bytes.size() < 24 || bytes.substr(12, 4) != "IHDR") return std::nullopt;
  return ImageHeader{ImageFormat::Png, big_endian_side(bytes, 16), big_endian_side(bytes, 20)};
}

bool is_frame_marker(unsigned marker) {
  const bool is_table = marker == 0xc4 || marker == 0xc8 || marker == 0xcc;
  return marker >= 0xc0 && marker <= 0xcf && !is_table;
}

/// Walks JPEG's marker segments up to the frame header, which holds the size.
std::optional<ImageHeader> jpeg_header(std::string_view bytes) {
  std::size_t at = 2;
  while (at + 9 <= bytes.size()) {
    if (byte_at(bytes, at) != 0xff) return std::nullopt;
    const unsigned marker = byte_at(bytes, at + 1);
    if (marker == 0xff) {  // fill byte
      ++at;
      continue;
    }
    if (is_frame_marker(marker)) {
      return ImageHeader{ImageFormat::Jpeg, static_cast<int>(big_endian_16(bytes, at + 7)),
                         static_cast<int>(big_endian_16(bytes, at + 5))};
    }
    const unsigned length = big_endian_16(bytes, at + 2);
    if (length < 2) return std::nullopt;
    at += 2 + length;
  }
  return std::nullopt;
}

}  // namespace

std::optional<ImageHeader> read_image_header(std::string_view bytes) {
  using namespace std::string_view_literals;
  if (bytes.starts_with("\x89PNG\r\n\x1a\n"sv)) return png_header(bytes);
  if (bytes.starts_with("\xff\xd8\xff"sv)) return jpeg_header(bytes);
  return std::nullopt;
}

bool has_whole_png_chunks(std::string_view bytes) {
  constexpr std::size_t kFrame = 12;  // length, name and check sum around a chunk's data
  for (std::size_t at = 8; at + kFrame <= bytes.size();) {
    const std::size_t length = big_endian_32(bytes, at);
    if (length > bytes.size() - at - kFrame) return false;
    if (bytes.substr(at + 4, 4) == "IEND") return true;
    at += kFrame + length;
  }
  return false;
}

bool can_hold_png_pixels(std::string_view bytes) {
  constexpr double kMostByDeflate = 1032;  // bytes out for a byte in
  constexpr std::size_t kDepthAt = 24, kColourTypeAt = 25;
  const auto header = png_header(bytes);
  if (!header || bytes.size() <= kColourTypeAt) return false;
  const unsigned type = byte_at(bytes, kColourTypeAt);
  const int channels = type == 2 ? 3 : type == 4 ? 2 : type == 6 ? 4 : 1;
  const double bits = 1.0 * header->width * header->height * channels * byte_at(bytes, kDepthAt);
  return bits / 8 <= kMostByDeflate * static_cast<double>(bytes.size());
}

}  // namespace morphbake
