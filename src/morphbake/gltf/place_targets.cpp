#include <algorithm>
#include <set>
#include <string>
#include <utility>

#include "morphbake/gltf/displacements.h"
#include "morphbake/gltf/morph_writing.h"

namespace morphbake {
namespace {

/// Gives a primitive's targets the same of the attributes that clients know: where a target lacks
/// one that others have, three.js takes the vertices' own normals or colours for displacements.
void complete_targets(Displacements& displacements, const Json& accessors, Eigen::Index vertices,
                      Json& targets) {
  for (const char* name :
       {"POSITION", "NORMAL", "TANGENT", "TEXCOORD_0", "TEXCOORD_1", "COLOR_0"}) {
    const auto has = [name](const Json& target) { return target.contains(name); };
    const auto first = std::find_if(targets.begin(), targets.end(), has);
    if (first == targets.end()) continue;
    const std::string type = accessors.at(first->at(name).get<std::size_t>()).at("type");
    if (!type.starts_with("VEC")) continue;  // not legal; whatever it means
    for (Json& target : targets) {
      if (!has(target)) target[name] = displacements.zeros(vertices, type);
    }
  }
}

void append_targets(MorphWriting& writing, Displacements& displacements,
                    const PrimitiveMorph& morph, Json& primitive) {
  for (std::size_t t = 0; t < morph.target_positions.size(); ++t) {
    Json target = {{"POSITION", displacements.append(morph.target_positions[t])}};
    if (!morph.target_normals.empty()) {
      target["NORMAL"] = displacements.append(morph.target_normals[t]);
    }
    if (!morph.target_colours.empty()) {
      target["COLOR_0"] = displacements.append(morph.target_colours[t]);
    }
    primitive["targets"].push_back(std::move(target));
  }
  const auto targets = primitive.find("targets");
  if (targets == primitive.end()) return;
  complete_targets(displacements, writing.draft.accessors, morph.positions.rows(), *targets);
}

/// Importers look for names in extras.targetNames. Extras of another kind than an object, which are
/// legal, are kept inside the new object. Own targets without a name get their number.
void name_targets(MorphWriting& writing) {
  Json& extras = mesh_of(writing)["extras"];
  if (!extras.is_null() && !extras.is_object()) extras = Json{{"extras", std::move(extras)}};
  if (extras.contains("targetNames") && !extras["targetNames"].is_array()) {
    Json other = std::move(extras["targetNames"]);  // whatever it means to its owner
    extras["targetNames"] = Json::array();
    extras["targetNames-2"] = std::move(other);
  }
  Json& names = extras["targetNames"];
  if (names.is_null()) names = Json::array();
  names.get_ref<Json::array_t&>().resize(std::min(names.size(), writing.own_targets));
  while (names.size() < writing.own_targets) names.push_back(std::to_string(names.size()));
  std::set<std::string> taken;
  for (const Json& name : names) {
    if (name.is_string()) taken.insert(name.get<std::string>());
  }
  for (const std::string& name : writing.morph.target_names) {
    names.push_back(*taken.insert(free_name(name, taken)).first);
  }
}

void append_weights(const MeshMorph& morph, Json& weights) {
  for (const float weight : first_weights(morph)) weights.push_back(static_cast<double>(weight));
}

/// Weights of mesh and nodes have one number a target.
void extend_weights(MorphWriting& writing) {
  Json& mesh = mesh_of(writing);
  Json& weights = mesh["weights"];
  if (!weights.is_array()) weights = Json::array();
  weights.get_ref<Json::array_t&>().resize(writing.own_targets, 0.0);
  append_weights(writing.morph, weights);
  for (Json& node : writing.draft.json["nodes"]) {
    if (node.value("mesh", -1) != writing.mesh || !node.contains("weights")) continue;
    node["weights"].get_ref<Json::array_t&>().resize(writing.own_targets, 0.0);
    append_weights(writing.morph, node["weights"]);
  }
}

}  // namespace

void place_targets(MorphWriting& writing) {
  const MeshMorph& morph = writing.morph;
  Json& primitives = mesh_of(writing)["primitives"];
  Displacements displacements(writing.draft, morph.may_be_sparse);
  for (std::size_t p = 0; p < morph.primitives.size(); ++p) {
    append_targets(writing, displacements, morph.primitives[p], primitives[p]);
  }
  name_targets(writing);
  extend_weights(writing);
}

}  // namespace morphbake
