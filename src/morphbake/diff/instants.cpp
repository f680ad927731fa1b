#include "morphbake/diff/instants.h"

#include <algorithm>
#include <cmath>

namespace morphbake {
namespace {

constexpr std::size_t kFewestFrames = 5;
constexpr double kEven = 1e-3;  // of the distance between frames: keys are floats

/// Seconds that exporters differ by where they write one time.
double rounding_at(double time) { return 1e-6 * std::max(1.0, std::abs(time)); }

bool is_same_moment(double a, double b) { return std::abs(a - b) <= rounding_at(a); }

/// Keys of both in order; each is taken once.
std::vector<Instant> common_keys(const std::vector<float>& a, const std::vector<float>& b) {
  std::vector<Instant> keys;
  std::size_t i = 0, j = 0;
  while (i < a.size() || j < b.size()) {
    const double in_a = i < a.size() ? a[i] : HUGE_VAL;
    const double in_b = j < b.size() ? b[j] : HUGE_VAL;
    if (i < a.size() && j < b.size() && is_same_moment(in_a, in_b)) {
      keys.push_back({in_a, in_b, true, true});
      ++i, ++j;
    } else if (in_a < in_b) {
      keys.push_back({in_a, in_a, true, false});
      ++i;
    } else {
      keys.push_back({in_b, in_b, false, true});
      ++j;
    }
  }
  return keys;
}

}  // namespace

std::vector<Instant> common_instants(const CurvePair& curves) {
  const std::vector<Instant> keys = common_keys(curves.a.times, curves.b.times);
  if (keys.empty()) return {Instant{}};
  std::vector<Instant> instants{keys.front()};
  for (std::size_t i = 1; i < keys.size(); ++i) {
    const Instant &before = keys[i - 1], &after = keys[i];
    instants.push_back({(before.time_a + after.time_a) / 2, (before.time_b + after.time_b) / 2});
    instants.push_back(after);
  }
  return instants;
}

bool is_sampled(const AnimationCurve& curve) {
  const std::vector<float>& times = curve.times;
  if (curve.interpolation != Interpolation::Linear || times.size() < kFewestFrames) return false;
  // Floats lie that far apart at the end of the clip.
  const double rounding = rounding_at(times.back());
  const double step = static_cast<double>(times[2]) - static_cast<double>(times[1]);
  for (std::size_t i = 1; i < times.size(); ++i) {
    const double gap = static_cast<double>(times[i]) - static_cast<double>(times[i - 1]);
    const bool may_be_short = i == 1 || i + 1 == times.size();
    if (gap > step * (1 + kEven) + rounding) return false;
    if (!may_be_short && gap < step * (1 - kEven) - rounding) return false;
  }
  return true;
}

bool have_same_keys(const CurvePair& curves) {
  return std::ranges::equal(curves.a.times, curves.b.times, is_same_moment);
}

}  // namespace morphbake
