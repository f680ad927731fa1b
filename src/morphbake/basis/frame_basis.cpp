#include <fmt/core.h>

#include <algorithm>
#include <utility>

#include "morphbake/basis/keyframes.h"
#include "morphbake/basis/morph_basis.h"
#include "morphbake/basis/principal_shapes.h"

namespace morphbake {
namespace {

/// Weights of a moment between frames, of which each fades into the next.
///
/// @param of_frame  #frames by #targets
Eigen::VectorXd weights_between(const std::vector<double>& times, const Eigen::MatrixXd& of_frame,
                                double time) {
  const auto next = static_cast<Eigen::Index>(
      std::lower_bound(times.begin(), times.end() - 1, time) - times.begin());
  if (next == 0) return of_frame.row(0);
  const double from = times[static_cast<std::size_t>(next) - 1];
  const double share =
      std::min(1.0, (time - from) / (times[static_cast<std::size_t>(next)] - from));
  return (1 - share) * of_frame.row(next - 1) + share * of_frame.row(next);
}

/// Keys where a clip begins, ends and has a frame between.
WeightKeys clip_keys(const std::vector<double>& times, const Eigen::MatrixXd& of_frame,
                     const Clip& clip) {
  std::vector<double> moments = times;
  std::erase_if(moments, [&](double time) { return time <= clip.begin || time >= clip.end; });
  moments.insert(moments.begin(), clip.begin);
  moments.push_back(clip.end);
  std::vector<double> taken;
  WeightKeys keys;
  for (const double time : moments) {
    const auto at = static_cast<float>(time - clip.begin);
    if (!keys.times.empty() && at <= keys.times.back()) continue;
    keys.times.push_back(at);
    taken.push_back(time);
  }
  keys.weights.resize(static_cast<Eigen::Index>(taken.size()), of_frame.cols());
  for (std::size_t k = 0; k < taken.size(); ++k) {
    const Eigen::VectorXd weights = weights_between(times, of_frame, taken[k]);
    keys.weights.row(static_cast<Eigen::Index>(k)) =
        weights.cast<float>().cwiseMax(0.0F).cwiseMin(1.0F).transpose();
  }
  return keys;
}

void add_clips(const std::vector<double>& times, const Eigen::MatrixXd& of_frame,
               const std::vector<Clip>& clips, MorphBasis& basis) {
  for (const Clip& clip : clips) basis.clips.push_back(clip_keys(times, of_frame, clip));
}

/// The target among those there are that is this very displacement, if there is one.
std::size_t same_target(const std::vector<MorphTarget>& targets, const Positions& displacement) {
  const auto is_same = [&](const MorphTarget& target) {
    return target.displacement == displacement;
  };
  return static_cast<std::size_t>(std::find_if(targets.begin(), targets.end(), is_same) -
                                  targets.begin());
}

/// Makes all weights run from 0 to 1, since importers clamp them: what a target is at least, the
/// base has; what it moves beyond that is the target.
void fold_ranges(Eigen::MatrixXd& of_frame, MorphBasis& basis) {
  for (std::size_t k = 0; k < basis.targets.size(); ++k) {
    auto column = of_frame.col(static_cast<Eigen::Index>(k));
    Positions& displacement = basis.targets[k].displacement;
    const double least = column.minCoeff(), range = column.maxCoeff() - least;
    basis.base += least * displacement;
    displacement *= range;
    column.array() -= least;
    if (range > 0) column /= range;
  }
}

MorphTarget target_of(const FrameSource& frames, std::size_t frame, const Positions& base) {
  return {fmt::format("frame-{:04d}", frame), frames.positions(frame) - base};
}

}  // namespace

MorphBasis keyframe_basis(const FrameSource& frames, double tolerance,
                          const std::vector<Clip>& clips, const Observer& observer) {
  const std::vector<std::size_t> chosen = choose_keyframes(frames, tolerance, observer);
  MorphBasis basis;
  basis.base = frames.positions(0);
  basis.kind = TargetKind::Keyframes;
  std::vector<double> times;
  std::vector<Eigen::Index> target_of_key;  // -1: the base
  for (const std::size_t frame : chosen) {
    times.push_back(frames.times[frame]);
    MorphTarget target = target_of(frames, frame, basis.base);
    if (target.displacement.isZero(0)) {
      target_of_key.push_back(-1);
      continue;
    }
    const std::size_t same = same_target(basis.targets, target.displacement);
    target_of_key.push_back(static_cast<Eigen::Index>(same));
    if (same == basis.targets.size()) basis.targets.push_back(std::move(target));
  }
  Eigen::MatrixXd weights = Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(chosen.size()),
                                                  static_cast<Eigen::Index>(basis.targets.size()));
  for (std::size_t k = 0; k < chosen.size(); ++k) {
    if (target_of_key[k] >= 0) weights(static_cast<Eigen::Index>(k), target_of_key[k]) = 1;
  }
  add_clips(times, weights, clips, basis);
  return basis;
}

MorphBasis frame_basis(const FrameSource& frames, const std::vector<Clip>& clips) {
  MorphBasis basis;
  basis.base = frames.positions(0);
  basis.kind = TargetKind::Frames;
  const auto count = static_cast<Eigen::Index>(frames.times.size());
  Eigen::MatrixXd weights = Eigen::MatrixXd::Zero(count, count - 1);
  for (std::size_t frame = 1; frame < frames.times.size(); ++frame) {
    basis.targets.push_back(target_of(frames, frame, basis.base));
    weights(static_cast<Eigen::Index>(frame), static_cast<Eigen::Index>(frame) - 1) = 1;
  }
  add_clips(frames.times, weights, clips, basis);
  return basis;
}

MorphBasis principal_basis(const FrameSource& frames, double tolerance,
                           const std::vector<Clip>& clips, const Observer& observer) {
  PrincipalShapes principal = principal_shapes(frames, tolerance, observer);
  MorphBasis basis;
  basis.base = frames.positions(0);
  basis.kind = TargetKind::Basis;
  for (std::size_t k = 0; k < principal.shapes.size(); ++k) {
    basis.targets.push_back({fmt::format("shape-{:02d}", k + 1), std::move(principal.shapes[k])});
  }
  fold_ranges(principal.weights, basis);
  add_clips(frames.times, principal.weights, clips, basis);
  return basis;
}

}  // namespace morphbake
