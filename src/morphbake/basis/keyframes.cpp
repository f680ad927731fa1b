#include "morphbake/basis/keyframes.h"

#include <algorithm>
#include <cmath>

namespace morphbake {
namespace {

/// A straight way from frame to frame.
struct Segment {
  std::size_t from = 0;
  std::size_t to = 0;
};

/// How far frame `at` is from the way: squared, largest of all vertices.
double squared_distance(const FrameBlock& block, const std::vector<double>& times,
                        const Segment& way, std::size_t at, Eigen::VectorXd* largest) {
  const double share = (times[at] - times[way.from]) / (times[way.to] - times[way.from]);
  const double* a = block.row(static_cast<Eigen::Index>(way.from)).data();
  const double* b = block.row(static_cast<Eigen::Index>(way.to)).data();
  const double* x = block.row(static_cast<Eigen::Index>(at)).data();
  double most = 0;
  for (Eigen::Index v = 0; v < block.cols() / 3; ++v) {
    double squared = 0;
    for (Eigen::Index i = 3 * v; i < 3 * v + 3; ++i) {
      const double off = x[i] - (a[i] + share * (b[i] - a[i]));
      squared += off * off;
    }
    most = std::max(most, squared);
    if (largest != nullptr) (*largest)(v) = std::max((*largest)(v), squared);
  }
  return most;
}

/// Frames between the ends that are tried first are those that mostly stray most.
bool is_straight(const FrameBlock& block, const std::vector<double>& times, const Segment& way,
                 double tolerance) {
  const std::size_t middle = (way.from + way.to) / 2;
  const auto strays = [&](std::size_t at) {
    return squared_distance(block, times, way, at, nullptr) > tolerance * tolerance;
  };
  if (middle > way.from && strays(middle)) return false;
  for (std::size_t at = way.from + 1; at < way.to; ++at) {
    if (at != middle && strays(at)) return false;
  }
  return true;
}

/// The farthest frame whose way from `from` is straight: by doubling, then halving.
std::size_t farthest(const FrameBlock& block, const std::vector<double>& times, std::size_t from,
                     double tolerance) {
  const std::size_t last = times.size() - 1;
  std::size_t good = from + 1, step = 2;
  std::size_t bad = last + 1;
  while (good < last && bad == last + 1) {
    const std::size_t to = std::min(last, from + step);
    if (is_straight(block, times, {from, to}, tolerance)) {
      good = to;
    } else {
      bad = to;
    }
    step *= 2;
  }
  while (bad - good > 1) {
    const std::size_t to = good + (bad - good) / 2;
    (is_straight(block, times, {from, to}, tolerance) ? good : bad) = to;
  }
  return good;
}

std::vector<std::size_t> keyframes_of(const FrameBlock& block, const std::vector<double>& times,
                                      double tolerance) {
  std::vector<std::size_t> keys{0};
  while (keys.back() + 1 < times.size()) {
    keys.push_back(farthest(block, times, keys.back(), tolerance));
  }
  return keys;
}

Eigen::VectorXd distances_from(const FrameBlock& block, const std::vector<double>& times,
                               const std::vector<std::size_t>& keys) {
  Eigen::VectorXd squared = Eigen::VectorXd::Zero(block.cols() / 3);
  for (std::size_t k = 1; k < keys.size(); ++k) {
    for (std::size_t at = keys[k - 1] + 1; at < keys[k]; ++at) {
      squared_distance(block, times, {keys[k - 1], keys[k]}, at, &squared);
    }
  }
  return squared.cwiseSqrt();
}

}  // namespace

std::vector<std::size_t> choose_keyframes(const FrameSource& frames, double tolerance,
                                          const Observer& observer) {
  std::vector<Eigen::Index> seen = spread_vertices(frames);
  while (true) {
    const std::vector<std::size_t> keys =
        keyframes_of(read_vertices(frames, seen), frames.times, tolerance);
    const std::vector<Eigen::Index> left = strays(
        frames, [&](const FrameBlock& block) { return distances_from(block, frames.times, keys); },
        tolerance, observer);
    if (left.empty()) return keys;
    seen.insert(seen.end(), left.begin(), left.end());
  }
}

}  // namespace morphbake
