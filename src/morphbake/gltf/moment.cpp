#include "morphbake/gltf/moment.h"

#include <Eigen/Geometry>
#include <map>
#include <string>

#include "morphbake/gltf/animation_curve.h"
#include "morphbake/gltf/names.h"
#include "morphbake/gltf/nodes.h"

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
  std::vector<Eigen::Matrix4d> locals = rest_transforms(document);
  const std::vector<tinygltf::Node>& nodes = document.model.nodes;
  std::map<std::size_t, MovedNode> moved;
  for (const tinygltf::AnimationChannel& channel :
       document.model.animations[static_cast<std::size_t>(animation)].channels) {
    const auto node = static_cast<std::size_t>(channel.target_node);
    if (channel.target_node < 0 || node >= nodes.size() || channel.target_path == "weights") {
      continue;
    }
    const tinygltf::Node& rest = nodes[node];
    MovedNode& at = moved.try_emplace(node, MovedNode{rest.translation, rest.rotation, rest.scale})
                        .first->second;
    if (channel.target_path == "rotation") {
      const Eigen::Vector4d xyzw =
          rotation_at(read_curve(document, animation, channel.sampler, 4), moment.time).coeffs();
      at.rotation = as_vector(xyzw);
      continue;
    }
    const Eigen::VectorXd numbers =
        value_at(read_curve(document, animation, channel.sampler, 3), moment.time);
    (channel.target_path == "scale" ? at.scale : at.translation) = as_vector(numbers);
  }
  for (const auto& [node, at] : moved) {
    locals[node] = transform_of(at.translation, at.rotation, at.scale);
  }
  return locals;
}

}  // namespace morphbake
