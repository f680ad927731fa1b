#include "morphbake/gltf/nodes.h"

#include <fmt/core.h>

#include <Eigen/Geometry>

namespace morphbake {
namespace {

Eigen::Matrix4d local_transform(const tinygltf::Node& node) {
  if (node.matrix.size() == 16) return Eigen::Map<const Eigen::Matrix4d>(node.matrix.data());
  Eigen::Affine3d transform = Eigen::Affine3d::Identity();
  if (node.translation.size() == 3) {
    transform.translate(Eigen::Map<const Eigen::Vector3d>(node.translation.data()));
  }
  if (node.rotation.size() == 4) {
    const auto& q = node.rotation;
    transform.rotate(Eigen::Quaterniond(q[3], q[0], q[1], q[2]).normalized());
  }
  if (node.scale.size() == 3) transform.scale(Eigen::Map<const Eigen::Vector3d>(node.scale.data()));
  return transform.matrix();
}

struct Visit {
  int node;
  Eigen::Matrix4d parent_to_scene;
};

std::vector<int> root_nodes(const GltfDocument& document) {
  const tinygltf::Model& model = document.model;
  if (!model.scenes.empty()) {
    const int scene = model.defaultScene < 0 ? 0 : model.defaultScene;
    if (static_cast<std::size_t>(scene) >= model.scenes.size()) {
      fail_at(document, "/scene", "gltf.invalid", fmt::format("scene {} does not exist", scene));
    }
    return model.scenes[static_cast<std::size_t>(scene)].nodes;
  }
  std::vector<bool> is_child(model.nodes.size(), false);
  for (const tinygltf::Node& node : model.nodes) {
    for (const int child : node.children) {
      if (child >= 0 && static_cast<std::size_t>(child) < is_child.size()) {
        is_child[static_cast<std::size_t>(child)] = true;
      }
    }
  }
  std::vector<int> roots;
  for (std::size_t node = 0; node < is_child.size(); ++node) {
    if (!is_child[node]) roots.push_back(static_cast<int>(node));
  }
  return roots;
}

}  // namespace

std::vector<MeshNode> find_mesh_nodes(const GltfDocument& document) {
  const std::vector<tinygltf::Node>& nodes = document.model.nodes;
  std::vector<bool> visited(nodes.size(), false);
  std::vector<Visit> stack;
  const std::vector<int> roots = root_nodes(document);
  for (auto root = roots.rbegin(); root != roots.rend(); ++root) {
    stack.push_back({*root, Eigen::Matrix4d::Identity()});
  }
  std::vector<MeshNode> found;
  while (!stack.empty()) {
    const Visit visit = stack.back();
    stack.pop_back();
    const auto index = static_cast<std::size_t>(visit.node);
    const std::string pointer = fmt::format("/nodes/{}", visit.node);
    if (visit.node < 0 || index >= nodes.size()) {
      fail_at(document, pointer, "gltf.invalid", fmt::format("node {} does not exist", visit.node));
    }
    if (visited[index]) {
      fail_at(document, pointer, "gltf.invalid",
              "the node has several parents or is its own ancestor");
    }
    visited[index] = true;
    const tinygltf::Node& node = nodes[index];
    const Eigen::Matrix4d to_scene = visit.parent_to_scene * local_transform(node);
    if (!to_scene.allFinite())
      fail_at(document, pointer, "gltf.not-finite", "the transform is not finite");
    if (node.mesh >= 0) found.push_back({visit.node, node.mesh, to_scene});
    for (auto child = node.children.rbegin(); child != node.children.rend(); ++child) {
      stack.push_back({*child, to_scene});
    }
  }
  return found;
}

}  // namespace morphbake
