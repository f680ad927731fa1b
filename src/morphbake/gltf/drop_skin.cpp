#include <fmt/core.h>

#include <algorithm>

#include "morphbake/gltf/animation_pointer.h"
#include "morphbake/gltf/morph_writing.h"
#include "morphbake/gltf/nodes.h"

namespace morphbake {
namespace {

Json& node_of(MorphWriting& writing) {
  return writing.draft.json["nodes"][static_cast<std::size_t>(writing.morph.node)];
}

/// Without a skin the node's own transform counts.
void check_transform(const MorphWriting& writing) {
  const GltfDocument& document = writing.document;
  const auto node = static_cast<std::size_t>(writing.morph.node);
  const NodeOrder order = order_nodes(document, rest_transforms(document));
  if (is_invertible(order.to_scene[node])) return;
  fail_at(document, fmt::format("/nodes/{}", node), "gltf.singular-transform",
          "the first source is posed by its skeleton and loses its skin, but then the node's "
          "transform flattens the mesh",
          "name a source in its rest pose first, or apply the node's transform");
}

/// Takes out a skin that no node has any more; skins are known by their numbers.
void remove_unused_skin(MorphWriting& writing, std::size_t skin) {
  Json& json = writing.draft.json;
  const auto skins = json.find("skins");
  if (!writing.references.are_all || skins == json.end() || skin >= skins->size()) return;
  for (const Json& node : json["nodes"]) {
    if (node.contains("skin") && node["skin"] == skin) return;
  }
  if (const auto matrices = (*skins)[skin].find("inverseBindMatrices");
      matrices != (*skins)[skin].end()) {
    release_accessor(writing.draft, writing.references, matrices->get<int>(), 1);
  }
  skins->erase(skin);
  if (skins->empty()) json.erase("skins");
  for (Json& node : json["nodes"]) {
    const auto number = node.find("skin");
    if (number != node.end() && *number > skin) *number = number->get<std::size_t>() - 1;
  }
}

/// Lets what moves the weights of mesh `own` move those of its copy too.
void copy_pointed_channels(MorphWriting& writing, std::size_t own) {
  const auto animations = writing.draft.json.find("animations");
  if (animations == writing.draft.json.end()) return;
  for (Json& animation : *animations) {
    Json& channels = animation.at("channels");
    const std::size_t count = channels.size();
    for (std::size_t c = 0; c < count; ++c) {
      const auto pointed = pointed_property(channels[c].at("target"));
      if (!pointed || pointed->list != "meshes" || pointed->index != own) continue;
      if (pointed->property != "weights") continue;
      Json copy = channels[c];
      copy["target"]["extensions"]["KHR_animation_pointer"]["pointer"] =
          fmt::format("/meshes/{}/weights", writing.mesh);
      channels.push_back(std::move(copy));
    }
  }
}

}  // namespace

void separate_posed_mesh(MorphWriting& writing) {
  const Json& nodes = writing.draft.json["nodes"];
  const auto is_posed_too = [&](const Json& node) {
    return &node != &node_of(writing) && node.contains("skin") &&
           node.value("mesh", -1) == writing.mesh;
  };
  if (!std::any_of(nodes.begin(), nodes.end(), is_posed_too)) return;
  Json& meshes = writing.draft.json["meshes"];
  meshes.push_back(Json(mesh_of(writing)));
  const auto own = static_cast<std::size_t>(writing.mesh);
  writing.mesh = static_cast<int>(meshes.size()) - 1;
  node_of(writing)["mesh"] = writing.mesh;
  copy_pointed_channels(writing, own);
}

void drop_skin(MorphWriting& writing) {
  check_transform(writing);
  Json& node = node_of(writing);
  const auto skin = node.at("skin").get<std::size_t>();
  node.erase("skin");
  for (Json& primitive : mesh_of(writing)["primitives"]) {
    Json kept = Json::object();
    for (const auto& [name, accessor] : primitive["attributes"].items()) {
      if (name.starts_with("JOINTS_") || name.starts_with("WEIGHTS_")) {
        release_accessor(writing.draft, writing.references, accessor.get<int>(), 1);
      } else {
        kept[name] = accessor;
      }
    }
    primitive["attributes"] = std::move(kept);
  }
  remove_unused_skin(writing, skin);
}

}  // namespace morphbake
