#include <algorithm>
#include <array>
#include <cassert>

#include "morphbake/images/images.h"
#include "morphbake/images/srgb.h"

namespace morphbake {
namespace {

/// The source pixels under one pixel of a smaller row or column, with the share that each covers.
struct Footprint {
  int first = 0;
  std::vector<float> shares;  ///< sum to 1
};

std::vector<Footprint> footprints(int source_size, int size) {
  std::vector<Footprint> all(static_cast<std::size_t>(size));
  const double scale = static_cast<double>(source_size) / size;
  for (int i = 0; i < size; ++i) {
    const double begin = i * scale;
    const double end = std::min<double>((i + 1) * scale, source_size);
    Footprint& print = all[static_cast<std::size_t>(i)];
    print.first = static_cast<int>(begin);
    for (int s = print.first; s < end; ++s) {
      const double share = std::min<double>(end, s + 1) - std::max<double>(begin, s);
      print.shares.push_back(static_cast<float>(share / scale));
    }
  }
  return all;
}

std::array<float, 3> box_average(const Image& image, const Footprint& columns,
                                 const Footprint& rows) {
  std::array<float, 3> sum{};
  for (std::size_t r = 0; r < rows.shares.size(); ++r) {
    const std::size_t row = static_cast<std::size_t>(rows.first) + r;
    for (std::size_t c = 0; c < columns.shares.size(); ++c) {
      const std::size_t column = static_cast<std::size_t>(columns.first) + c;
      const std::uint8_t* pixel =
          &image.rgb[(row * static_cast<std::size_t>(image.width) + column) * 3];
      const float share = rows.shares[r] * columns.shares[c];
      for (std::size_t k = 0; k < 3; ++k) sum[k] += share * srgb_to_linear(pixel[k]);
    }
  }
  return sum;
}

}  // namespace

Image scale_down(const Image& image, int width, int height) {
  assert(width >= 1 && width <= image.width && height >= 1 && height <= image.height);
  const std::vector<Footprint> columns = footprints(image.width, width);
  const std::vector<Footprint> rows = footprints(image.height, height);
  Image small{width, height, {}};
  small.rgb.reserve(static_cast<std::size_t>(width) * static_cast<std::size_t>(height) * 3);
  for (const Footprint& row : rows) {
    for (const Footprint& column : columns) {
      for (const float value : box_average(image, column, row)) {
        small.rgb.push_back(linear_to_srgb(value));
      }
    }
  }
  return small;
}

}  // namespace morphbake
