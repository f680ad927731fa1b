#include "morphbake/images/lzw.h"

namespace morphbake {
namespace {

constexpr unsigned kClear = 256;
constexpr unsigned kEnd = 257;
constexpr unsigned kFirstFree = 258;
constexpr unsigned kLastCode = 4095;

/// Packs codes into bytes, low bits first.
struct BitStream {
  std::string bytes;
  std::uint32_t pending = 0;
  int pending_bits = 0;

  void put(unsigned code, int width) {
    pending |= code << pending_bits;
    for (pending_bits += width; pending_bits >= 8; pending_bits -= 8, pending >>= 8) {
      bytes.push_back(static_cast<char>(pending & 0xff));
    }
  }

  void flush() {
    if (pending_bits > 0) bytes.push_back(static_cast<char>(pending & 0xff));
    pending = 0;
    pending_bits = 0;
  }
};

}  // namespace

std::string lzw_compress(const std::vector<std::uint8_t>& indices) {
  // children[prefix * 256 + index] is the code of that string, 0 for none: 2 MB beat a hash map by
  // far.
  std::vector<std::uint16_t> children(std::size_t{kLastCode + 1} * 256);
  BitStream stream;
  unsigned next_code = kFirstFree;
  int width = 9;
  stream.put(kClear, width);
  unsigned prefix = kClear;  // no string yet
  for (const std::uint8_t index : indices) {
    if (prefix == kClear) {
      prefix = index;
      continue;
    }
    std::uint16_t& child = children[std::size_t{prefix} * 256 + index];
    if (child != 0) {
      prefix = child;
      continue;
    }
    stream.put(prefix, width);
    prefix = index;
    if (next_code <= kLastCode) {
      child = static_cast<std::uint16_t>(next_code);
      // The decoder is one entry behind, so the width grows when the new code itself needs it.
      if (next_code == (1u << width)) ++width;
      ++next_code;
    } else {
      stream.put(kClear, width);
      children.assign(children.size(), 0);
      next_code = kFirstFree;
      width = 9;
    }
  }
  if (prefix != kClear) {
    stream.put(prefix, width);
    if (next_code == (1u << width) && width < 12) ++width;  // the decoder adds one more entry here
  }
  stream.put(kEnd, width);
  stream.flush();
  return std::move(stream.bytes);
}

}  // namespace morphbake
