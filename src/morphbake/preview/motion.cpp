#include "morphbake/preview/motion.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace morphbake {
namespace {

/// Weights that differ less than this are one pose: file weights are float32.
constexpr double kSameWeight = 1e-6;

bool ends_as_it_begins(const AnimatedMesh& mesh) {
  const auto& keys = mesh.weights.values;
  if (keys.rows() < 2) return true;
  return (keys.row(0) - keys.row(keys.rows() - 1)).lpNorm<Eigen::Infinity>() <= kSameWeight;
}

}  // namespace

PlayedSpan played_span(const AnimatedMesh& mesh) {
  const std::vector<float>& times = mesh.weights.times;
  if (times.empty()) return {};
  return {times.front(), times.back(), !ends_as_it_begins(mesh)};
}

PlayedSpan common_span(const std::vector<PlayedSpan>& spans) {
  PlayedSpan all = spans.front();
  for (const PlayedSpan& span : spans) {
    all = {std::min(all.begin, span.begin), std::max(all.end, span.end),
           all.returns || span.returns};
  }
  return all;
}

double time_at(const PlayedSpan& span, double phase) {
  const double share = span.returns ? 1.0 - std::abs(1.0 - 2.0 * phase) : phase;
  return span.begin + (span.end - span.begin) * share;
}

double orbit_azimuth(const TurntableOptions& options, double phase) {
  const bool whole_turns = std::remainder(options.orbit, 360.0) == 0.0;
  if (whole_turns) return options.azimuth + options.orbit * phase;
  return options.azimuth + options.orbit / 2 * std::sin(2 * std::numbers::pi * phase);
}

std::vector<LoopMoment> loop_moments(const AnimatedMesh& mesh, const PlayedSpan& span,
                                     const TurntableOptions& options) {
  std::vector<LoopMoment> moments;
  for (int i = 0; i < options.frames; ++i) {
    const double phase = static_cast<double>(i) / options.frames;
    LoopMoment moment;
    moment.time = time_at(span, phase);
    if (mesh.weights.values.rows() > 0) moment.weights = weights_at(mesh, moment.time);
    moment.azimuth = orbit_azimuth(options, phase) * std::numbers::pi / 180.0;
    moments.push_back(moment);
  }
  return moments;
}

}  // namespace morphbake
