#pragma once

#include <array>
#include <cstdint>
#include <stdexcept>
#include <string>
#include <vector>

#include "morphbake/images/images.h"

namespace morphbake {

/// What a player makes of a GIF.
struct PlayedGif {
  bool loops_for_ever = false;
  std::vector<Image> frames;
  std::vector<int> delays;  ///< hundredths of a second
};

/// An independent reader of GIF89a with a global palette, written from the specification.
class GifReader {
 public:
  explicit GifReader(std::string bytes) : bytes_(std::move(bytes)) {}

  PlayedGif read() {
    if (take(6) != "GIF89a") throw std::runtime_error("no GIF89a");
    const int width = take_16(), height = take_16();
    const int flags = take_8();
    take(2);
    palette_ = take(3u << ((flags & 7) + 1));
    canvas_ = {width, height, std::vector<std::uint8_t>(std::size_t(width) * height * 3)};
    for (int block = take_8(); block != 0x3b; block = take_8()) {
      if (block == 0x21) read_extension();
      if (block == 0x2c) read_picture();
    }
    if (at_ != bytes_.size()) throw std::runtime_error("bytes after the end");
    return played_;
  }

 private:
  std::string take(std::size_t count) {
    if (at_ + count > bytes_.size()) throw std::runtime_error("cut short");
    at_ += count;
    return bytes_.substr(at_ - count, count);
  }

  int take_8() { return static_cast<unsigned char>(take(1)[0]); }

  int take_16() {
    const int low = take_8();
    return low | take_8() << 8;
  }

  std::string take_sub_blocks() {
    std::string data;
    for (int length = take_8(); length != 0; length = take_8()) data += take(length);
    return data;
  }

  void read_extension() {
    const int label = take_8();
    const std::string data = take_sub_blocks();
    if (label == 0xff && data == std::string("NETSCAPE2.0\x01\0\0", 14)) {
      played_.loops_for_ever = true;
    }
    if (label != 0xf9) return;
    played_.delays.push_back(static_cast<unsigned char>(data[1]) |
                             static_cast<unsigned char>(data[2]) << 8);
    transparent_ = (data[0] & 1) != 0 ? static_cast<unsigned char>(data[3]) : -1;
  }

  void read_picture() {
    const int left = take_16(), top = take_16(), width = take_16(), height = take_16();
    if (take_8() != 0) throw std::runtime_error("local palette or interlace");
    const int bits = take_8();
    const std::vector<int> indices = unpack(take_sub_blocks(), bits);
    if (indices.size() != std::size_t(width) * height) throw std::runtime_error("pixels missing");
    for (std::size_t i = 0; i < indices.size(); ++i) {
      if (indices[i] == transparent_) continue;
      const int x = left + int(i) % width, y = top + int(i) / width;
      if (x >= canvas_.width || y >= canvas_.height) throw std::runtime_error("outside");
      for (int k = 0; k < 3; ++k) {
        canvas_.rgb[(std::size_t(y) * canvas_.width + x) * 3 + k] =
            static_cast<std::uint8_t>(palette_[std::size_t(indices[i]) * 3 + k]);
      }
    }
    played_.frames.push_back(canvas_);
  }

  static std::vector<int> unpack(const std::string& data, int bits) {
    const int clear = 1 << bits;
    std::vector<std::vector<int>> strings;
    const auto reset = [&] {
      strings.assign(clear + 2, {});
      for (int i = 0; i < clear; ++i) strings[i] = {i};
    };
    reset();
    std::vector<int> result, previous;
    int width = bits + 1;
    for (std::size_t bit = 0; bit + width <= data.size() * 8;) {
      int code = 0;
      for (int i = 0; i < width; ++i, ++bit) code |= (data[bit / 8] >> (bit % 8) & 1) << i;
      if (code == clear) {
        reset();
        previous.clear();
        width = bits + 1;
        continue;
      }
      if (code == clear + 1) return result;
      std::vector<int> entry = previous;
      if (code < int(strings.size())) {
        entry = strings[code];
      } else {
        if (previous.empty() || code > int(strings.size())) throw std::runtime_error("bad code");
        entry.push_back(previous[0]);
      }
      result.insert(result.end(), entry.begin(), entry.end());
      if (!previous.empty() && strings.size() < 4096) {
        previous.push_back(entry[0]);
        strings.push_back(previous);
      }
      if (strings.size() == std::size_t(1) << width && width < 12) ++width;
      previous = entry;
    }
    throw std::runtime_error("no end code");
  }

  std::string bytes_;
  std::size_t at_ = 0;
  std::string palette_;
  int transparent_ = -1;
  Image canvas_;
  PlayedGif played_;
};

}  // namespace morphbake
