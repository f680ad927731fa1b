// SPDX-License-Identifier: GPL-3.0-or-later
#include "png.h"

#include <zlib.h>

#include <array>
#include <cstdlib>
#include <limits>
#include <stdexcept>

namespace shapes {
namespace {

constexpr std::size_t channels = 3;

void append_word(std::string& bytes, std::size_t word) {
  for (const int shift : {24, 16, 8, 0}) bytes += static_cast<char>(word >> shift & 0xff);
}

const Bytef* data_of(const std::string& bytes) {
  return reinterpret_cast<const Bytef*>(bytes.data());
}

void append_chunk(std::string& file, const std::string& type, const std::string& data) {
  const std::string checked = type + data;
  append_word(file, data.size());
  file += checked;
  append_word(file, crc32(0, data_of(checked), static_cast<uInt>(checked.size())));
}

int paeth(int left, int above, int corner) {
  const int to_left = std::abs(above - corner);
  const int to_above = std::abs(left - corner);
  const int to_corner = std::abs(left + above - 2 * corner);
  if (to_left <= to_above && to_left <= to_corner) return left;
  return to_above <= to_corner ? above : corner;
}

/// One row after one of PNG's five filters, preceded by the filter's number.
std::string filtered(const std::vector<std::uint8_t>& row, const std::vector<std::uint8_t>& above,
                     int filter) {
  std::string bytes(1, static_cast<char>(filter));
  for (std::size_t i = 0; i < row.size(); ++i) {
    const int left = i < channels ? 0 : row[i - channels];
    const int corner = i < channels ? 0 : above[i - channels];
    const std::array<int, 5> guesses{0, left, above[i], (left + above[i]) / 2,
                                     paeth(left, above[i], corner)};
    bytes += static_cast<char>(row[i] - guesses[static_cast<std::size_t>(filter)]);
  }
  return bytes;
}

/// The usual rule of thumb: the filter whose differences are smallest compresses best.
std::string best_filtered(const std::vector<std::uint8_t>& row,
                          const std::vector<std::uint8_t>& above) {
  std::string best;
  long least = std::numeric_limits<long>::max();
  for (int filter = 0; filter < 5; ++filter) {
    std::string bytes = filtered(row, above, filter);
    long sum = 0;
    for (std::size_t i = 1; i < bytes.size(); ++i)
      sum += std::abs(static_cast<signed char>(bytes[i]));
    if (sum >= least) continue;
    least = sum;
    best = std::move(bytes);
  }
  return best;
}

std::string deflated(const std::string& bytes) {
  uLongf size = compressBound(static_cast<uLong>(bytes.size()));
  std::string result(size, '\0');
  if (compress2(reinterpret_cast<Bytef*>(result.data()), &size, data_of(bytes),
                static_cast<uLong>(bytes.size()), Z_BEST_COMPRESSION) != Z_OK)
    throw std::runtime_error("png: zlib cannot compress");
  result.resize(size);
  return result;
}

}  // namespace

std::string png(int size, const std::vector<std::uint8_t>& rgb) {
  const std::size_t width = channels * static_cast<std::size_t>(size);
  std::vector<std::uint8_t> above(width, 0);
  std::string rows;
  for (std::size_t begin = 0; begin < rgb.size(); begin += width) {
    const auto first = rgb.begin() + static_cast<std::ptrdiff_t>(begin);
    const std::vector<std::uint8_t> row(first, first + static_cast<std::ptrdiff_t>(width));
    rows += best_filtered(row, above);
    above = row;
  }
  std::string header;
  append_word(header, static_cast<std::size_t>(size));
  append_word(header, static_cast<std::size_t>(size));
  header += std::string("\x08\x02\x00\x00\x00", 5);  // 8 bits, RGB, nothing interlaced
  std::string file = "\x89PNG\r\n\x1a\n";
  append_chunk(file, "IHDR", header);
  append_chunk(file, "IDAT", deflated(rows));
  append_chunk(file, "IEND", "");
  return file;
}

}  // namespace shapes
