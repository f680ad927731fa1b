#include "morphbake/atlas/fill_gaps.h"

#include <Eigen/Core>
#include <algorithm>
#include <cstddef>

#include "morphbake/images/srgb.h"

namespace morphbake {
namespace {

/// Means of known colours; the last number tells whether there is one.
struct Level {
  int width = 0;
  int height = 0;
  std::vector<Eigen::Array4f> means;  ///< linear RGB, 1 or 0

  Eigen::Array4f& at(int x, int y) {
    return means[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
                 static_cast<std::size_t>(x)];
  }
};

/// The half of what `texel` (x, y -> colour, 1 or 0) gives.
template <typename Texel>
Level halved(int width, int height, const Texel& texel) {
  Level level{(width + 1) / 2, (height + 1) / 2, {}};
  level.means.reserve(static_cast<std::size_t>(level.width) *
                      static_cast<std::size_t>(level.height));
  for (int y = 0; y < height; y += 2) {
    for (int x = 0; x < width; x += 2) {
      Eigen::Array4f sum = Eigen::Array4f::Zero();
      for (int j = y; j < std::min(y + 2, height); ++j) {
        for (int i = x; i < std::min(x + 2, width); ++i) sum += texel(i, j);
      }
      level.means.push_back(sum(3) > 0 ? Eigen::Array4f(sum / sum(3)) : sum);
    }
  }
  return level;
}

}  // namespace

void fill_gaps(Image& image, const std::vector<char>& known) {
  const auto index = [&](int x, int y) {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(image.width) +
           static_cast<std::size_t>(x);
  };
  std::vector<Level> levels;
  levels.push_back(halved(image.width, image.height, [&](int x, int y) {
    if (known[index(x, y)] == 0) return Eigen::Array4f(Eigen::Array4f::Zero());
    const std::uint8_t* rgb = &image.rgb[3 * index(x, y)];
    return Eigen::Array4f(srgb_to_linear(rgb[0]), srgb_to_linear(rgb[1]), srgb_to_linear(rgb[2]),
                          1);
  }));
  while (std::max(levels.back().width, levels.back().height) > 1) {
    Level& last = levels.back();
    levels.push_back(halved(last.width, last.height, [&](int x, int y) { return last.at(x, y); }));
  }
  for (std::size_t l = levels.size() - 1; l-- > 0;) {
    for (int y = 0; y < levels[l].height; ++y) {
      for (int x = 0; x < levels[l].width; ++x) {
        Eigen::Array4f& mean = levels[l].at(x, y);
        if (mean(3) == 0) mean = levels[l + 1].at(x / 2, y / 2);
      }
    }
  }
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      if (known[index(x, y)] != 0) continue;
      const Eigen::Array4f& mean = levels.front().at(x / 2, y / 2);
      for (int c = 0; c < 3; ++c) {
        image.rgb[3 * index(x, y) + static_cast<std::size_t>(c)] = linear_to_srgb(mean(c));
      }
    }
  }
}

}  // namespace morphbake
