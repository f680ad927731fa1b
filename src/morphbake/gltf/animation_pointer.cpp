#include "morphbake/gltf/animation_pointer.h"

#include <fmt/core.h>

#include <algorithm>
#include <charconv>
#include <iterator>
#include <map>
#include <string_view>
#include <vector>

namespace morphbake {
namespace {

constexpr std::size_t kMostPointed = std::size_t{1} << 17;  // of some hundred bytes each

bool is_plain(std::string_view property) {
  return property == "translation" || property == "rotation" || property == "scale" ||
         property == "weights";
}

using NodesOfMeshes = std::map<std::size_t, std::vector<int>>;

/// Nodes that show each mesh with the mesh's own weights.
NodesOfMeshes nodes_of_meshes(const tinygltf::Model& model) {
  NodesOfMeshes nodes;
  for (std::size_t n = 0; n < model.nodes.size(); ++n) {
    const tinygltf::Node& node = model.nodes[n];
    if (node.mesh < 0 || !node.weights.empty()) continue;
    nodes[static_cast<std::size_t>(node.mesh)].push_back(static_cast<int>(n));
  }
  return nodes;
}

/// The nodes that a pointed property of plain channels belongs to.
std::vector<int> nodes_moved(const tinygltf::Model& model, const NodesOfMeshes& of_meshes,
                             const PointedProperty& pointed) {
  if (pointed.list == "nodes" && pointed.index < model.nodes.size()) {
    return {static_cast<int>(pointed.index)};
  }
  if (pointed.list != "meshes" || pointed.property != "weights") return {};
  const auto shown = of_meshes.find(pointed.index);
  return shown == of_meshes.end() ? std::vector<int>() : shown->second;
}

}  // namespace

std::optional<PointedProperty> pointed_property(const Json& target) {
  static const Json::json_pointer place("/extensions/KHR_animation_pointer/pointer");
  if (target.value("path", "") != "pointer" || !target.contains(place)) return std::nullopt;
  const Json& told = target.at(place);
  if (!told.is_string()) return std::nullopt;
  const std::string_view pointer = told.get_ref<const std::string&>();
  const std::size_t second = pointer.find('/', 1);
  if (!pointer.starts_with('/') || second == std::string_view::npos) return std::nullopt;
  PointedProperty found;
  found.list = pointer.substr(1, second - 1);
  const char* begin = pointer.data() + second + 1;
  const char* end = pointer.data() + pointer.size();
  const auto [rest, error] = std::from_chars(begin, end, found.index);
  const bool is_index = error == std::errc() && rest != end && *rest == '/';
  if (!is_index || (*begin == '0' && rest != begin + 1)) return std::nullopt;
  found.property = std::string(rest + 1, end);
  return found;
}

void follow_pointers(GltfDocument& document) {
  const auto animations = document.json.find("animations");
  if (animations == document.json.end()) return;
  tinygltf::Model& model = document.model;
  const NodesOfMeshes of_meshes = nodes_of_meshes(model);
  std::size_t left = kMostPointed;
  for (std::size_t a = 0; a < model.animations.size(); ++a) {
    const Json& told = (*animations)[a].at("channels");
    std::vector<tinygltf::AnimationChannel> of_nodes, of_mesh;
    for (std::size_t c = 0; c < told.size(); ++c) {
      const auto pointed = pointed_property(told[c].at("target"));
      if (!pointed || !is_plain(pointed->property)) continue;
      const std::vector<int> nodes = nodes_moved(model, of_meshes, *pointed);
      if (nodes.size() > left) {
        fail_at(document, fmt::format("/animations/{}/channels/{}", a, c), "gltf.too-large",
                fmt::format("channels of KHR_animation_pointer move more than {} nodes in all",
                            kMostPointed),
                "let nodes have channels of their own");
      }
      left -= nodes.size();
      for (const int node : nodes) {
        tinygltf::AnimationChannel channel;
        channel.sampler = told[c].at("sampler").get<int>();
        channel.target_node = node;
        channel.target_path = pointed->property;
        (pointed->list == "nodes" ? of_nodes : of_mesh).push_back(std::move(channel));
      }
    }
    // The first channel of a node's weights counts, and its own come before its mesh's.
    auto& channels = model.animations[a].channels;
    std::ranges::move(of_nodes, std::back_inserter(channels));
    std::ranges::move(of_mesh, std::back_inserter(channels));
  }
}

}  // namespace morphbake
