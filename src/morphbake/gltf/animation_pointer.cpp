#include "morphbake/gltf/animation_pointer.h"

#include <fmt/core.h>

#include <charconv>
#include <map>
#include <string_view>
#include <vector>

#include "morphbake/gltf/size_limits.h"

namespace morphbake {
namespace {

bool is_plain(std::string_view property) {
  return property == "translation" || property == "rotation" || property == "scale" ||
         property == "weights";
}

/// Nodes that show each mesh with the mesh's own weights.
std::map<std::size_t, std::vector<int>> nodes_of_meshes(const tinygltf::Model& model) {
  std::map<std::size_t, std::vector<int>> nodes;
  for (std::size_t n = 0; n < model.nodes.size(); ++n) {
    const tinygltf::Node& node = model.nodes[n];
    if (node.mesh < 0 || !node.weights.empty()) continue;
    nodes[static_cast<std::size_t>(node.mesh)].push_back(static_cast<int>(n));
  }
  return nodes;
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
  if (error != std::errc() || rest == end || *rest != '/') return std::nullopt;
  found.property = std::string(rest + 1, end);
  return found;
}

void follow_pointers(GltfDocument& document) {
  const auto animations = document.json.find("animations");
  if (animations == document.json.end()) return;
  tinygltf::Model& model = document.model;
  const std::map<std::size_t, std::vector<int>> of_meshes = nodes_of_meshes(model);
  std::size_t added = 0;
  for (std::size_t a = 0; a < model.animations.size(); ++a) {
    auto& channels = model.animations[a].channels;
    const Json& told = (*animations)[a].at("channels");
    for (std::size_t c = 0; c < told.size(); ++c) {
      const auto pointed = pointed_property(told[c].at("target"));
      if (!pointed || !is_plain(pointed->property)) continue;
      std::vector<int> nodes;
      if (pointed->list == "nodes" && pointed->index < model.nodes.size()) {
        nodes = {static_cast<int>(pointed->index)};
      } else if (pointed->list == "meshes" && pointed->property == "weights") {
        const auto shown = of_meshes.find(pointed->index);
        if (shown != of_meshes.end()) nodes = shown->second;
      }
      added += nodes.size();
      if (added > kMostJsonValues) {
        fail_at(document, fmt::format("/animations/{}/channels/{}", a, c), "gltf.too-large",
                "animations of meshes' weights move millions of nodes",
                "let the nodes have channels of their own");
      }
      for (const int node : nodes) {
        tinygltf::AnimationChannel channel;
        channel.sampler = told[c].at("sampler").get<int>();
        channel.target_node = node;
        channel.target_path = pointed->property;
        channels.push_back(std::move(channel));
      }
    }
  }
}

}  // namespace morphbake
