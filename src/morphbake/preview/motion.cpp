#include "morphbake/preview/motion.h"

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

double played_share(const AnimatedMesh& mesh, double phase) {
  return ends_as_it_begins(mesh) ? phase : 1.0 - std::abs(1.0 - 2.0 * phase);
}

double orbit_azimuth(const TurntableOptions& options, double phase) {
  const bool whole_turns = std::remainder(options.orbit, 360.0) == 0.0;
  if (whole_turns) return options.azimuth + options.orbit * phase;
  return options.azimuth + options.orbit / 2 * std::sin(2 * std::numbers::pi * phase);
}

std::vector<LoopMoment> loop_moments(const AnimatedMesh& mesh, const TurntableOptions& options) {
  std::vector<LoopMoment> moments;
  for (int i = 0; i < options.frames; ++i) {
    const double phase = static_cast<double>(i) / options.frames;
    LoopMoment moment;
    if (mesh.weights.values.rows() > 0) {
      const double begin = mesh.weights.times.empty() ? 0.0 : mesh.weights.times.front();
      const double end = mesh.weights.times.empty() ? 0.0 : mesh.weights.times.back();
      moment.weights = weights_at(mesh, begin + (end - begin) * played_share(mesh, phase));
    }
    moment.azimuth = orbit_azimuth(options, phase) * std::numbers::pi / 180.0;
    moments.push_back(moment);
  }
  return moments;
}

}  // namespace morphbake
