#include "morphbake/gltf/skin.h"

#include <fmt/core.h>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>

#include "morphbake/gltf/accessors.h"
#include "morphbake/gltf/nodes.h"

namespace morphbake {
namespace {

/// Attribute `name` of a primitive, or -1.
int attribute(const tinygltf::Primitive& primitive, const std::string& name) {
  const auto found = primitive.attributes.find(name);
  return found == primitive.attributes.end() ? -1 : found->second;
}

/// Four joints and weights a vertex: JOINTS_n and WEIGHTS_n of one n.
struct BindingSet {
  std::vector<std::uint32_t> joints;
  std::vector<float> weights;
};

/// @param pointer  of the primitive's attributes
BindingSet read_set(const GltfDocument& document, const tinygltf::Primitive& primitive, int set,
                    std::size_t vertices, const std::string& pointer) {
  const std::string joints = fmt::format("JOINTS_{}", set);
  const std::string weights = fmt::format("WEIGHTS_{}", set);
  if (attribute(primitive, weights) < 0) {
    fail_at(document, pointer, "gltf.invalid", fmt::format("{} has no {}", joints, weights));
  }
  for (const std::string& name : {joints, weights}) {
    check_count(document, attribute(primitive, name), vertices,
                fmt::format("{}/{}", pointer, name));
  }
  return {read_joints(document, attribute(primitive, joints), pointer + "/" + joints),
          read_floats(document, attribute(primitive, weights), 4, pointer + "/" + weights)};
}

/// All sets of a primitive.
std::vector<BindingSet> read_sets(const GltfDocument& document,
                                  const tinygltf::Primitive& primitive, std::size_t joint_count,
                                  const std::string& pointer) {
  const std::size_t vertices =
      accessor_count(document, attribute(primitive, "POSITION"), pointer + "/POSITION");
  std::vector<BindingSet> sets;
  while (attribute(primitive, fmt::format("JOINTS_{}", sets.size())) >= 0) {
    const int number = static_cast<int>(sets.size());
    sets.push_back(read_set(document, primitive, number, vertices, pointer));
    const std::vector<std::uint32_t>& joints = sets.back().joints;
    const auto bad = std::ranges::find_if(
        joints, [joint_count](std::uint32_t joint) { return joint >= joint_count; });
    if (bad == joints.end()) continue;
    fail_at(document, pointer, "gltf.accessor",
            fmt::format("vertex {} hangs on joint {}, but the skin has {}",
                        (bad - joints.begin()) / 4, *bad, joint_count));
  }
  return sets;
}

}  // namespace

std::vector<Eigen::Matrix4d> joint_transforms(const GltfDocument& document, int index,
                                              const std::vector<Eigen::Matrix4d>& to_scene) {
  const std::string pointer = fmt::format("/skins/{}", index);
  const tinygltf::Skin& skin = document.model.skins[static_cast<std::size_t>(index)];
  if (skin.joints.empty()) {
    fail_at(document, pointer + "/joints", "gltf.invalid", "the skin has no joint");
  }
  std::vector<float> inverse;
  if (skin.inverseBindMatrices >= 0) {
    inverse = read_floats(document, skin.inverseBindMatrices, 16, pointer + "/inverseBindMatrices");
    if (inverse.size() < 16 * skin.joints.size()) {
      fail_at(document, pointer + "/inverseBindMatrices", "gltf.accessor",
              fmt::format("there are {} matrices for {} joints", inverse.size() / 16,
                          skin.joints.size()));
    }
  }
  std::vector<Eigen::Matrix4d> transforms;
  for (std::size_t j = 0; j < skin.joints.size(); ++j) {
    transforms.push_back(to_scene[static_cast<std::size_t>(skin.joints[j])]);
    if (inverse.empty()) continue;
    transforms.back() *= Eigen::Map<const Eigen::Matrix4f>(inverse.data() + 16 * j).cast<double>();
  }
  return transforms;
}

Eigen::Matrix4d bound_to_scene(const std::vector<Eigen::Matrix4d>& joints) {
  const auto found = std::ranges::find_if(joints, is_invertible);
  return found == joints.end() ? Eigen::Matrix4d::Identity() : *found;
}

SkinBinding read_binding(const GltfDocument& document, const tinygltf::Primitive& primitive,
                         std::size_t joint_count, const std::string& pointer) {
  const std::vector<BindingSet> sets =
      read_sets(document, primitive, joint_count, pointer + "/attributes");
  const std::size_t vertices = sets.empty() ? 0 : sets.front().joints.size() / 4;
  SkinBinding binding;
  binding.width = 4 * sets.size();
  binding.joints.reserve(vertices * binding.width);
  binding.weights.reserve(vertices * binding.width);
  for (std::size_t v = 0; v < vertices; ++v) {
    float sum = 0;
    for (const BindingSet& set : sets) {
      for (std::size_t k = 4 * v; k < 4 * v + 4; ++k) {
        binding.joints.push_back(set.joints[k]);
        binding.weights.push_back(set.weights[k]);
        sum += set.weights[k];
      }
    }
    if (sum == 0) continue;
    std::for_each(binding.weights.end() - static_cast<std::ptrdiff_t>(binding.width),
                  binding.weights.end(), [sum](float& weight) { weight /= sum; });
  }
  return binding;
}

void pose(const SkinBinding& binding, const std::vector<Eigen::Matrix4d>& transforms,
          Float3s& positions, Float3s& normals) {
  for (Eigen::Index v = 0; v < positions.rows() && binding.width > 0; ++v) {
    Eigen::Matrix4d blend = Eigen::Matrix4d::Zero();
    for (std::size_t k = 0; k < binding.width; ++k) {
      const std::size_t at = static_cast<std::size_t>(v) * binding.width + k;
      if (binding.weights[at] != 0) blend += binding.weights[at] * transforms[binding.joints[at]];
    }
    if (blend.isZero(0)) continue;  // hangs on nothing
    const Eigen::Matrix3d linear = blend.topLeftCorner<3, 3>();
    const Eigen::Vector3d position = positions.row(v).transpose().cast<double>();
    positions.row(v) = (linear * position + blend.topRightCorner<3, 1>()).transpose().cast<float>();
    if (normals.rows() == 0) continue;
    // Normals turn by the inverse transpose; where that does not exist they stay.
    const Eigen::Vector3d normal = normals.row(v).transpose().cast<double>();
    const Eigen::Vector3d turned = linear.inverse().transpose() * normal;
    if (turned.allFinite() && !turned.isZero(0)) {
      normals.row(v) = turned.normalized().transpose().cast<float>();
    }
  }
}

}  // namespace morphbake
