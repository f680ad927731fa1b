#include "morphbake/images/gif_palette.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <utility>

namespace morphbake {
namespace {

constexpr int kRefinements = 6;  ///< of k-means; more change no colour by a visible amount

/// The distinct colours of all frames in order of appearance; nothing when there are more than
/// `size`.
std::vector<Colour8> few_colours(const std::vector<Image>& frames, std::size_t size) {
  std::vector<bool> seen(std::size_t{1} << 24);
  std::vector<Colour8> colours;
  for (const Image& frame : frames) {
    for (std::size_t i = 0; i + 2 < frame.rgb.size(); i += 3) {
      const Colour8 colour{frame.rgb[i], frame.rgb[i + 1], frame.rgb[i + 2]};
      const std::size_t key =
          std::size_t{colour[0]} << 16 | std::size_t{colour[1]} << 8 | colour[2];
      if (seen[key]) continue;
      if (colours.size() == size) return {};
      seen[key] = true;
      colours.push_back(colour);
    }
  }
  return colours;
}

/// Colours that share the top 6 bits of each channel.
struct Bin {
  std::array<double, 3> colour{};  ///< mean, 0 to 255
  double weight = 0;
};

using Bins = std::vector<Bin>;

/// Weights are square roots of the counts: the backdrop's millions of pixels must not take the
/// palette from a small bright eye.
Bins histogram(const std::vector<Image>& frames) {
  std::vector<Bin> cells(std::size_t{1} << 18);
  for (const Image& frame : frames) {
    for (std::size_t i = 0; i + 2 < frame.rgb.size(); i += 3) {
      const unsigned r = frame.rgb[i], g = frame.rgb[i + 1], b = frame.rgb[i + 2];
      Bin& bin = cells[(r >> 2) << 12 | (g >> 2) << 6 | b >> 2];
      bin.colour[0] += r;
      bin.colour[1] += g;
      bin.colour[2] += b;
      bin.weight += 1;
    }
  }
  std::erase_if(cells, [](const Bin& bin) { return bin.weight == 0; });
  for (Bin& bin : cells) {
    for (double& channel : bin.colour) channel /= bin.weight;
    bin.weight = std::sqrt(bin.weight);
  }
  return cells;
}

/// A run of bins with the moments that choose the next cut.
struct Box {
  std::size_t begin = 0;
  std::size_t end = 0;
  std::array<double, 3> mean{};
  int axis = 0;       ///< channel of the largest spread
  double spread = 0;  ///< sum of weighted squared distances along `axis`
};

Box measured(const Bins& bins, std::size_t begin, std::size_t end) {
  Box box{begin, end, {}, 0, 0};
  double weight = 0;
  std::array<double, 3> squares{};
  for (std::size_t i = begin; i < end; ++i) {
    weight += bins[i].weight;
    for (std::size_t k = 0; k < 3; ++k) {
      box.mean[k] += bins[i].weight * bins[i].colour[k];
      squares[k] += bins[i].weight * bins[i].colour[k] * bins[i].colour[k];
    }
  }
  for (std::size_t k = 0; k < 3; ++k) {
    box.mean[k] /= weight;
    const double spread = squares[k] - weight * box.mean[k] * box.mean[k];
    if (spread > box.spread) {
      box.spread = spread;
      box.axis = static_cast<int>(k);
    }
  }
  return box;
}

std::vector<std::array<double, 3>> median_cut(Bins& bins, std::size_t size) {
  std::vector<Box> boxes{measured(bins, 0, bins.size())};
  while (boxes.size() < std::min(size, bins.size())) {
    const auto worst = std::max_element(
        boxes.begin(), boxes.end(), [](const Box& a, const Box& b) { return a.spread < b.spread; });
    const Box box = *worst;
    const std::size_t axis = static_cast<std::size_t>(box.axis);
    const auto first = bins.begin() + static_cast<std::ptrdiff_t>(box.begin);
    const auto last = bins.begin() + static_cast<std::ptrdiff_t>(box.end);
    const auto middle = std::partition(
        first, last, [&](const Bin& bin) { return bin.colour[axis] < box.mean[axis]; });
    if (middle == first || middle == last) break;  // the spread left is rounding
    const std::size_t cut = static_cast<std::size_t>(middle - bins.begin());
    *worst = measured(bins, box.begin, cut);
    boxes.push_back(measured(bins, cut, box.end));
  }
  std::vector<std::array<double, 3>> means;
  for (const Box& box : boxes) means.push_back(box.mean);
  return means;
}

template <class A, class B>
auto squared_distance(const A& a, const B& b) {
  const auto x = a[0] - b[0], y = a[1] - b[1], z = a[2] - b[2];
  return x * x + y * y + z * z;
}

void refine(const Bins& bins, std::vector<std::array<double, 3>>& means) {
  std::vector<Bin> sums(means.size());
  for (const Bin& bin : bins) {
    std::size_t best = 0;
    double best_distance = std::numeric_limits<double>::max();
    for (std::size_t m = 0; m < means.size(); ++m) {
      const double distance = squared_distance(bin.colour, means[m]);
      if (distance < best_distance) {
        best_distance = distance;
        best = m;
      }
    }
    for (std::size_t k = 0; k < 3; ++k) sums[best].colour[k] += bin.weight * bin.colour[k];
    sums[best].weight += bin.weight;
  }
  for (std::size_t m = 0; m < means.size(); ++m) {
    if (sums[m].weight == 0) continue;
    for (std::size_t k = 0; k < 3; ++k) means[m][k] = sums[m].colour[k] / sums[m].weight;
  }
}

/// Threshold of a pixel in 1/64: the 8 x 8 Bayer matrix, by interleaving the bits of x ^ y and y.
int bayer_threshold(int x, int y) {
  int threshold = 0;
  for (int bit = 0; bit < 3; ++bit) {
    const int odd = (x ^ y) >> bit & 1;
    const int row = y >> bit & 1;
    threshold |= (odd << 1 | row) << (2 * (2 - bit));
  }
  return threshold;
}

}  // namespace

std::vector<Colour8> common_palette(const std::vector<Image>& frames, int size) {
  assert(size >= 1 && size <= 256);
  if (auto colours = few_colours(frames, static_cast<std::size_t>(size)); !colours.empty()) {
    return colours;
  }
  Bins bins = histogram(frames);
  std::vector<std::array<double, 3>> means = median_cut(bins, static_cast<std::size_t>(size));
  for (int i = 0; i < kRefinements; ++i) refine(bins, means);
  std::vector<Colour8> palette;
  for (const auto& mean : means) {
    Colour8 colour{};
    for (std::size_t k = 0; k < 3; ++k) colour[k] = static_cast<std::uint8_t>(std::lround(mean[k]));
    palette.push_back(colour);
  }
  return palette;
}

DitheredPalette::DitheredPalette(std::vector<Colour8> colours) : colours_(std::move(colours)) {
  assert(!colours_.empty() && colours_.size() <= 256);
}

std::uint8_t DitheredPalette::nearest(const std::array<int, 3>& colour) const {
  std::size_t best = 0;
  int best_distance = std::numeric_limits<int>::max();
  for (std::size_t i = 0; i < colours_.size(); ++i) {
    const int distance = squared_distance(colour, colours_[i]);
    if (distance < best_distance) {
      best_distance = distance;
      best = i;
    }
  }
  return static_cast<std::uint8_t>(best);
}

DitheredPalette::Mix DitheredPalette::mix_of(const Colour8& colour) const {
  const std::array<int, 3> exact{colour[0], colour[1], colour[2]};
  Mix mix;
  mix.near = nearest(exact);
  const Colour8& a = colours_[mix.near];
  // Look on the other side of the colour, as far again as the nearest entry is, and a bit more.
  std::array<int, 3> beyond{};
  for (std::size_t k = 0; k < 3; ++k) beyond[k] = exact[k] + 2 * (exact[k] - a[k]);
  mix.far = nearest(beyond);
  const Colour8& b = colours_[mix.far];
  const int length = squared_distance(a, b);
  if (length == 0) return mix;
  int along = 0;
  for (std::size_t k = 0; k < 3; ++k) along += (exact[k] - a[k]) * (b[k] - a[k]);
  mix.share = static_cast<std::uint8_t>(std::clamp(64 * along / length, 0, 32));
  return mix;
}

std::vector<std::uint8_t> DitheredPalette::indices(const Image& image) {
  std::vector<std::uint8_t> result;
  result.reserve(image.rgb.size() / 3);
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      const std::uint8_t* rgb = &image.rgb[result.size() * 3];
      const std::uint32_t key = std::uint32_t{rgb[0]} << 16 | std::uint32_t{rgb[1]} << 8 | rgb[2];
      auto [entry, is_new] = mixes_.try_emplace(key);
      if (is_new) entry->second = mix_of({rgb[0], rgb[1], rgb[2]});
      const Mix& mix = entry->second;
      result.push_back(bayer_threshold(x, y) < mix.share ? mix.far : mix.near);
    }
  }
  return result;
}

}  // namespace morphbake
