#include "morphbake/gltf/animation_curve.h"

#include <fmt/core.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <utility>

#include "morphbake/gltf/accessors.h"

namespace morphbake {
namespace {

using Rows = Eigen::Matrix<float, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// Where `time` is between the keys.
struct KeySpan {
  Eigen::Index before = 0;
  Eigen::Index after = 0;
  double share = 0;    ///< of the way from before to after
  double seconds = 0;  ///< from before to after
};

KeySpan span_at(const std::vector<float>& times, double time) {
  const auto after = std::upper_bound(times.begin(), times.end(), time);
  if (after == times.begin()) return {};
  const Eigen::Index next = after - times.begin();
  if (after == times.end()) return {next - 1, next - 1, 0, 0};
  const double begin = *(after - 1);
  const double seconds = *after - begin;
  return {next - 1, next, (time - begin) / seconds, seconds};
}

std::string sampler_pointer(int animation, int sampler) {
  return fmt::format("/animations/{}/samplers/{}", animation, sampler);
}

Interpolation interpolation_of(const std::string& name) {
  if (name == "STEP") return Interpolation::Step;
  return name == "CUBICSPLINE" ? Interpolation::CubicSpline : Interpolation::Linear;
}

void check_times(const GltfDocument& document, const std::vector<float>& times,
                 const std::string& pointer) {
  const auto fault = std::adjacent_find(times.begin(), times.end(),
                                        [](float early, float late) { return !(early < late); });
  if (fault == times.end() && times.front() >= 0) return;
  fail_at(document, pointer, "gltf.accessor",
          fmt::format("key {} of the animation is at {} s; keys start at 0 or later and rise",
                      fault == times.end() ? 0 : fault - times.begin() + 1,
                      fault == times.end() ? times.front() : *(fault + 1)));
}

/// Checks how many numbers the output has, before any is read.
///
/// @param keys     of the sampler
/// @param of_key   numbers that each needs
/// @param pointer  of the sampler
/// @return         numbers an element
int check_output(const GltfDocument& document, const tinygltf::AnimationSampler& sampler,
                 std::size_t keys, std::size_t of_key, const std::string& pointer) {
  const std::string place = pointer + "/output";
  const std::size_t count = accessor_count(document, sampler.output, place);
  const auto width = static_cast<std::size_t>(accessor_columns(document, sampler.output, place));
  // Counts are below 2^32 each: products cannot overflow.
  if (count * width == keys * of_key) return static_cast<int>(width);
  fail_at(document, place, "gltf.accessor",
          fmt::format("the output has {} numbers; {} keys of {} need {}", count * width, keys,
                      of_key, keys * of_key));
}

}  // namespace

const tinygltf::AnimationSampler& animation_sampler(const GltfDocument& document, int animation,
                                                    int sampler) {
  const auto& samplers = document.model.animations[static_cast<std::size_t>(animation)].samplers;
  if (sampler < 0 || static_cast<std::size_t>(sampler) >= samplers.size()) {
    fail_at(document, sampler_pointer(animation, sampler), "gltf.invalid",
            "the sampler does not exist");
  }
  return samplers[static_cast<std::size_t>(sampler)];
}

const tinygltf::AnimationChannel* weights_channel(const tinygltf::Animation& animation, int node) {
  const auto found =
      std::ranges::find_if(animation.channels, [node](const tinygltf::AnimationChannel& channel) {
        return channel.target_node == node && channel.target_path == "weights";
      });
  return found == animation.channels.end() ? nullptr : &*found;
}

AnimationCurve read_curve(const GltfDocument& document, int animation, int sampler, int columns) {
  const tinygltf::AnimationSampler& source = animation_sampler(document, animation, sampler);
  const std::string pointer = sampler_pointer(animation, sampler);
  AnimationCurve curve;
  curve.interpolation = interpolation_of(source.interpolation);
  curve.times = read_floats(document, source.input, 1, pointer + "/input");
  check_times(document, curve.times, pointer + "/input");
  const std::size_t parts = curve.interpolation == Interpolation::CubicSpline ? 3 : 1;
  const int width = check_output(document, source, curve.times.size(),
                                 static_cast<std::size_t>(columns) * parts, pointer);
  const std::vector<float> numbers =
      read_floats(document, source.output, width, pointer + "/output");
  const auto keys = static_cast<Eigen::Index>(curve.times.size());
  if (parts == 1) {
    curve.values = Eigen::Map<const Rows>(numbers.data(), keys, columns);
    return curve;
  }
  // In-tangent, value and out-tangent follow one another at each key.
  const Eigen::Map<const Rows> all(numbers.data(), keys, 3 * columns);
  curve.in_tangents = all.leftCols(columns);
  curve.values = all.middleCols(columns, columns);
  curve.out_tangents = all.rightCols(columns);
  return curve;
}

Eigen::VectorXd value_at(const AnimationCurve& curve, double time) {
  const KeySpan at = span_at(curve.times, time);
  const auto row = [](const Eigen::MatrixXf& rows, Eigen::Index i) -> Eigen::VectorXd {
    return rows.row(i).cast<double>();
  };
  const Eigen::VectorXd before = row(curve.values, at.before);
  if (at.before == at.after || curve.interpolation == Interpolation::Step) return before;
  const Eigen::VectorXd after = row(curve.values, at.after);
  const double t = at.share;
  if (curve.interpolation == Interpolation::Linear) return (1 - t) * before + t * after;
  const double t2 = t * t, t3 = t2 * t;
  return (2 * t3 - 3 * t2 + 1) * before +
         at.seconds * (t3 - 2 * t2 + t) * row(curve.out_tangents, at.before) +
         (3 * t2 - 2 * t3) * after + at.seconds * (t3 - t2) * row(curve.in_tangents, at.after);
}

Eigen::Quaterniond rotation_at(const AnimationCurve& curve, double time) {
  const auto quaternion = [](const Eigen::Vector4d& xyzw) {
    return Eigen::Quaterniond(xyzw.w(), xyzw.x(), xyzw.y(), xyzw.z()).normalized();
  };
  const KeySpan at = span_at(curve.times, time);
  if (curve.interpolation != Interpolation::Linear || at.before == at.after) {
    return quaternion(value_at(curve, time));
  }
  const Eigen::Vector4d before = curve.values.row(at.before).transpose().cast<double>();
  const Eigen::Vector4d after = curve.values.row(at.after).transpose().cast<double>();
  return quaternion(before).slerp(at.share, quaternion(after));
}

}  // namespace morphbake
