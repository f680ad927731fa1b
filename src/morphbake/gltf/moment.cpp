#include "morphbake/gltf/moment.h"

#include <fmt/core.h>

#include <Eigen/Geometry>
#include <map>
#include <string>

#include "morphbake/gltf/accessors.h"
#include "morphbake/gltf/animation_curve.h"
#include "morphbake/gltf/names.h"
#include "morphbake/gltf/nodes.h"
#include "morphbake/gltf/size_limits.h"

namespace morphbake {
namespace {

struct MovedNode {
  std::vector<double> translation, rotation, scale;
};

int animation_of(const GltfDocument& document, const Moment& moment) {
  const NameOrIndex choice = is_chosen(moment.animation) ? moment.animation : NameOrIndex(0);
  return index_of_choice(document, choice, names_of(document.model.animations), "animation",
                         "/animations");
}

std::vector<double> as_vector(const Eigen::VectorXd& numbers) {
  return {numbers.data(), numbers.data() + numbers.size()};
}

/// What the samplers of an animation are at a moment, each read once however many channels it has.
class SampledCurves {
 public:
  SampledCurves(const GltfDocument& document, int animation, double time)
      : document_(document),
        animation_(animation),
        time_(time),
        numbers_left_(most_curve_numbers(document)) {}

  /// @throws BakeError as read_curve, "gltf.too-large"
  const Eigen::VectorXd& rotation(int sampler) {
    const auto [entry, is_new] = rotations_.try_emplace(sampler);
    if (is_new) entry->second = rotation_at(curve(sampler, 4), time_).coeffs();
    return entry->second;
  }

  /// Likewise, of a translation or scale.
  const Eigen::VectorXd& vector(int sampler) {
    const auto [entry, is_new] = vectors_.try_emplace(sampler);
    if (is_new) entry->second = value_at(curve(sampler, 3), time_);
    return entry->second;
  }

 private:
  AnimationCurve curve(int sampler, int columns) {
    const std::string pointer = fmt::format("/animations/{}/samplers/{}", animation_, sampler);
    const auto& samplers =
        document_.model.animations[static_cast<std::size_t>(animation_)].samplers;
    if (sampler >= 0 && static_cast<std::size_t>(sampler) < samplers.size()) {
      const int input = samplers[static_cast<std::size_t>(sampler)].input;
      const std::size_t keys = accessor_count(document_, input, pointer + "/input");
      take(keys * static_cast<std::size_t>(1 + columns), pointer);
    }
    return read_curve(document_, animation_, sampler, columns);
  }

  void take(std::size_t numbers, const std::string& pointer) {
    if (numbers > numbers_left_) {
      fail_at(document_, pointer, "gltf.too-large",
              "the samplers of the animation ask for more numbers than the file has",
              "samplers that share one long accessor need one of their own each");
    }
    numbers_left_ -= numbers;
  }

  const GltfDocument& document_;
  int animation_ = 0;
  double time_ = 0;
  std::size_t numbers_left_ = 0;
  std::map<int, Eigen::VectorXd> rotations_, vectors_;  // by sampler
};

}  // namespace

Eigen::VectorXd weights_at(const GltfDocument& document, int node, const Moment& moment,
                           const Eigen::VectorXd& rest) {
  const int animation = animation_of(document, moment);
  for (const tinygltf::AnimationChannel& channel :
       document.model.animations[static_cast<std::size_t>(animation)].channels) {
    if (channel.target_node != node || channel.target_path != "weights" || rest.size() == 0) {
      continue;
    }
    return value_at(read_curve(document, animation, channel.sampler, static_cast<int>(rest.size())),
                    moment.time);
  }
  return rest;
}

std::vector<Eigen::Matrix4d> transforms_at(const GltfDocument& document, const Moment& moment) {
  const int animation = animation_of(document, moment);
  SampledCurves curves(document, animation, moment.time);
  std::vector<Eigen::Matrix4d> locals = rest_transforms(document);
  const std::vector<tinygltf::Node>& nodes = document.model.nodes;
  std::map<std::size_t, MovedNode> moved;
  for (const tinygltf::AnimationChannel& channel :
       document.model.animations[static_cast<std::size_t>(animation)].channels) {
    const auto node = static_cast<std::size_t>(channel.target_node);
    const std::string& path = channel.target_path;
    const bool moves = path == "translation" || path == "rotation" || path == "scale";
    if (channel.target_node < 0 || node >= nodes.size() || !moves) continue;
    const tinygltf::Node& rest = nodes[node];
    MovedNode& at = moved.try_emplace(node, MovedNode{rest.translation, rest.rotation, rest.scale})
                        .first->second;
    if (path == "rotation") {
      at.rotation = as_vector(curves.rotation(channel.sampler));
    } else {
      (path == "scale" ? at.scale : at.translation) = as_vector(curves.vector(channel.sampler));
    }
  }
  for (const auto& [node, at] : moved) {
    locals[node] = transform_of(at.translation, at.rotation, at.scale);
  }
  return locals;
}

}  // namespace morphbake
