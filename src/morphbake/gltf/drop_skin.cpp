#include <fmt/core.h>

#include <algorithm>

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
  writing.mesh = static_cast<int>(meshes.size()) - 1;
  node_of(writing)["mesh"] = writing.mesh;
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
