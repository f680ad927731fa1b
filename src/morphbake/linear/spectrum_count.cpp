#include "morphbake/linear/spectrum_count.h"

#include <algorithm>
#include <numeric>
#include <utility>

namespace morphbake {
namespace {

/// Above all eigenvalues. No simple number: eigenvalues of regular meshes are, and bisection must
/// not meet them.
constexpr double kAbove = 2.0123456789;

/// A guess comes no closer to an end of the interval than this share of it: it shrinks.
constexpr double kMargin = 0.05;

constexpr double kWeyl = 4;  ///< eigenvalues are about this many times their index / #V

}  // namespace

int Enclosure::total() const { return std::accumulate(counts.begin(), counts.end(), 0); }

SpectrumCount::SpectrumCount(const OneRings& rings)
    : components_(connected_components(rings)), factor_(rings) {}

Enclosure SpectrumCount::below(double lambda) {
  Enclosure found{lambda, std::vector<int>(static_cast<std::size_t>(components_.count), 0)};
  if (vertex_count() == 0 || !(lambda > 0)) return found;
  const bool is_above = lambda > 2;
  if (!is_above) found.lambda = factor_.factorise(lambda);
  for (std::size_t v = 0; v < components_.label.size(); ++v) {
    if (is_above || factor_.pivots()(static_cast<Eigen::Index>(v)) < 0) {
      ++found.counts[static_cast<std::size_t>(components_.label[v])];
    }
  }
  return found;
}

Enclosure SpectrumCount::enclose(int fewest, int most, double precision, const Observer& observer) {
  double low = 0;
  Enclosure enclosure = below(kAbove);
  const double middle = (fewest + 1.0 * most) / 2;
  double guess = kWeyl * middle / std::max(1, vertex_count());
  while (enclosure.total() > most && enclosure.lambda - low > precision * enclosure.lambda) {
    stop_if_cancelled(observer);
    const double margin = kMargin * (enclosure.lambda - low);
    guess = std::clamp(guess, low + margin, enclosure.lambda - margin);
    Enclosure found = below(guess);
    const int count = found.total();
    if (count < fewest) {
      low = found.lambda;
    } else if (found.lambda < enclosure.lambda) {
      enclosure = std::move(found);
    } else {
      break;  // stepped past the upper end: the interval cannot shrink any more
    }
    guess *= middle / std::max(1, count);
  }
  return enclosure;
}

}  // namespace morphbake
