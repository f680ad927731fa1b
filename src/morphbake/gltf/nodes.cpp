#include "morphbake/gltf/nodes.h"

#include <fmt/core.h>
#include <fmt/format.h>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "morphbake/gltf/names.h"
#include "morphbake/gltf/skin.h"
#include "morphbake/json/nearest.h"

namespace morphbake {
namespace {

struct Visit {
  int node;
  Eigen::Matrix4d parent_to_scene;
};

/// Nodes that are nobody's child.
std::vector<int> parentless_nodes(const tinygltf::Model& model) {
  std::vector<bool> is_child(model.nodes.size(), false);
  for (const tinygltf::Node& node : model.nodes) {
    for (const int child : node.children) is_child[static_cast<std::size_t>(child)] = true;
  }
  std::vector<int> roots;
  for (std::size_t node = 0; node < is_child.size(); ++node) {
    if (!is_child[node]) roots.push_back(static_cast<int>(node));
  }
  return roots;
}

/// Roots of what is shown: a file without scenes shows all.
std::vector<int> shown_roots(const GltfDocument& document) {
  const tinygltf::Model& model = document.model;
  if (model.scenes.empty()) return parentless_nodes(model);
  const int scene = std::max(0, model.defaultScene);
  return model.scenes[static_cast<std::size_t>(scene)].nodes;
}

/// Appends the trees under `roots`.
void visit_trees(const GltfDocument& document, const std::vector<int>& roots,
                 const std::vector<Eigen::Matrix4d>& locals, std::vector<bool>& visited,
                 NodeOrder& order) {
  std::vector<Visit> stack;
  const auto push = [&](const std::vector<int>& nodes, const Eigen::Matrix4d& parent_to_scene) {
    for (auto node = nodes.rbegin(); node != nodes.rend(); ++node) {
      stack.push_back({*node, parent_to_scene});
    }
  };
  push(roots, Eigen::Matrix4d::Identity());
  while (!stack.empty()) {
    const Visit visit = stack.back();
    stack.pop_back();
    const auto index = static_cast<std::size_t>(visit.node);
    if (visited[index]) {
      fail_at(document, fmt::format("/nodes/{}", visit.node), "gltf.invalid",
              "the node has several parents, is its own ancestor, or is listed twice");
    }
    visited[index] = true;
    order.nodes.push_back(visit.node);
    order.to_scene[index] = visit.parent_to_scene * locals[index];
    if (!order.to_scene[index].allFinite()) {
      fail_at(document, fmt::format("/nodes/{}", visit.node), "gltf.not-finite",
              "the transform is not finite");
    }
    push(document.model.nodes[index].children, order.to_scene[index]);
  }
}

/// 3, or "hat" (3)
std::string shown_node(const GltfDocument& document, int node) {
  const std::string& name = document.model.nodes[static_cast<std::size_t>(node)].name;
  return name.empty() ? fmt::format("{}", node) : fmt::format("{} ({})", shown(Json(name)), node);
}

std::string shown_nodes(const GltfDocument& document, const std::vector<int>& nodes) {
  std::vector<std::string> names;
  for (const int node : nodes) names.push_back(shown_node(document, node));
  return name_list(names);
}

bool has_mesh(const GltfDocument& document, int node) {
  return document.model.nodes[static_cast<std::size_t>(node)].mesh >= 0;
}

std::vector<int> with_mesh(const GltfDocument& document, std::vector<int> nodes) {
  std::erase_if(nodes, [&](int node) { return !has_mesh(document, node); });
  return nodes;
}

/// The nodes that may be meant, those of the scene first.
std::vector<int> candidates(const GltfDocument& document, const MeshChoice& choice,
                            const NodeOrder& order) {
  const tinygltf::Model& model = document.model;
  const std::vector<int> all = with_mesh(document, order.nodes);
  if (all.empty()) {
    fail_at(document, "/nodes", "gltf.no-mesh", "no node of the file has a mesh",
            "export the mesh that is to be morphed");
  }
  if (is_chosen(choice.node)) {
    const int node =
        index_of_choice(document, choice.node, names_of(model.nodes), "node", "/nodes");
    if (!has_mesh(document, node)) {
      // Where integers have a scale, the mesh hangs on a node of its own below the one that has the
      // name.
      const std::vector<int> below =
          with_mesh(document, model.nodes[static_cast<std::size_t>(node)].children);
      if (below.size() == 1) return below;
      fail_at(document, fmt::format("/nodes/{}", node), "gltf.no-mesh",
              fmt::format("node {} has no mesh", shown_node(document, node)),
              fmt::format("nodes with a mesh: {}", shown_nodes(document, all)));
    }
    return {node};
  }
  if (is_chosen(choice.mesh)) return all;
  std::vector<int> shown = order.nodes;
  shown.resize(order.shown);
  shown = with_mesh(document, std::move(shown));
  if (!shown.empty()) return shown;
  fail_at(document, "/scenes", "gltf.no-mesh", "no node of the scene has a mesh",
          fmt::format("other nodes have: choose with \"node\": {}", shown_nodes(document, all)));
}

/// Those of the candidates that have the mesh that is chosen.
std::vector<int> with_chosen_mesh(const GltfDocument& document, const MeshChoice& choice,
                                  std::vector<int> nodes) {
  if (!is_chosen(choice.mesh)) return nodes;
  const tinygltf::Model& model = document.model;
  const int mesh =
      index_of_choice(document, choice.mesh, names_of(model.meshes), "mesh", "/meshes");
  std::erase_if(nodes,
                [&](int node) { return model.nodes[static_cast<std::size_t>(node)].mesh != mesh; });
  if (nodes.empty()) {
    fail_at(document, fmt::format("/meshes/{}", mesh), "gltf.no-such-mesh",
            is_chosen(choice.node) ? "the node that is chosen has another mesh"
                                   : "no node shows the mesh",
            "a morph needs a node that shows it");
  }
  nodes.resize(1);  // any other one shows the same
  return nodes;
}

void check_transform(const GltfDocument& document, const MeshNode& at) {
  if (is_invertible(at.to_scene)) return;
  fail_at(document, fmt::format("/nodes/{}", at.node), "gltf.singular-transform",
          "the node's transform flattens the mesh (determinant 0)",
          "apply the transform and export again");
}

}  // namespace

bool is_invertible(const Eigen::Matrix4d& transform) {
  return std::abs(transform.topLeftCorner<3, 3>().determinant()) > 1e-30;
}

Eigen::Matrix4d transform_of(const std::vector<double>& translation,
                             const std::vector<double>& rotation,
                             const std::vector<double>& scale) {
  Eigen::Affine3d transform = Eigen::Affine3d::Identity();
  if (translation.size() == 3) {
    transform.translate(Eigen::Map<const Eigen::Vector3d>(translation.data()));
  }
  if (rotation.size() == 4) {
    const auto& q = rotation;
    transform.rotate(Eigen::Quaterniond(q[3], q[0], q[1], q[2]).normalized());
  }
  if (scale.size() == 3) transform.scale(Eigen::Map<const Eigen::Vector3d>(scale.data()));
  return transform.matrix();
}

std::vector<Eigen::Matrix4d> rest_transforms(const GltfDocument& document) {
  std::vector<Eigen::Matrix4d> locals;
  for (const tinygltf::Node& node : document.model.nodes) {
    locals.push_back(node.matrix.size() == 16
                         ? Eigen::Matrix4d(Eigen::Map<const Eigen::Matrix4d>(node.matrix.data()))
                         : transform_of(node.translation, node.rotation, node.scale));
  }
  return locals;
}

NodeOrder order_nodes(const GltfDocument& document, const std::vector<Eigen::Matrix4d>& locals) {
  NodeOrder order;
  order.to_scene.assign(locals.size(), Eigen::Matrix4d::Identity());
  std::vector<bool> visited(locals.size(), false);
  visit_trees(document, shown_roots(document), locals, visited, order);
  order.shown = order.nodes.size();
  std::vector<int> others = parentless_nodes(document.model);
  std::erase_if(others, [&](int node) { return visited[static_cast<std::size_t>(node)]; });
  visit_trees(document, others, locals, visited, order);
  const auto lost = std::find(visited.begin(), visited.end(), false);
  if (lost != visited.end()) {
    fail_at(document, fmt::format("/nodes/{}", lost - visited.begin()), "gltf.invalid",
            "the node is its own ancestor");
  }
  return order;
}

MeshNode choose_mesh_node(const GltfDocument& document, const MeshChoice& choice,
                          Ambiguity ambiguity) {
  const NodeOrder order = order_nodes(document, rest_transforms(document));
  const std::vector<int> nodes =
      with_chosen_mesh(document, choice, candidates(document, choice, order));
  if (nodes.size() > 1 && ambiguity == Ambiguity::Refuse) {
    fail_at(
        document, fmt::format("/nodes/{}", nodes[1]), "gltf.several-meshes",
        fmt::format("{} nodes of the scene have a mesh", nodes.size()),
        fmt::format("choose one with \"node\" or \"mesh\" (in a command, --node); nodes are: {}",
                    shown_nodes(document, nodes)));
  }
  const tinygltf::Node& node = document.model.nodes[static_cast<std::size_t>(nodes[0])];
  MeshNode at{nodes[0], node.mesh, order.to_scene[static_cast<std::size_t>(nodes[0])]};
  if (node.skin >= 0) {
    at.to_scene = bound_to_scene(joint_transforms(document, node.skin, order.to_scene));
  }
  check_transform(document, at);
  return at;
}

}  // namespace morphbake
