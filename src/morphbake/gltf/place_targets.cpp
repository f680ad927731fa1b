#include <algorithm>
#include <map>
#include <set>
#include <string>
#include <utility>

#include "morphbake/gltf/morph_writing.h"

namespace morphbake {
namespace {

constexpr int kUnsignedByte = 5121;

/// Normal displacements for targets that have none: three.js takes the base normals for them where
/// only some targets have NORMAL.
class NoNormals {
 public:
  explicit NoNormals(GlbDraft& draft) : draft_(draft) {}

  /// Zeros of that many vertices. Clients disagree about accessors without any bytes, so one of the
  /// zeros is told.
  int accessor_of(Eigen::Index vertices) {
    const auto [entry, is_new] = accessors_.try_emplace(vertices, -1);
    if (is_new) entry->second = append(vertices);
    return entry->second;
  }

 private:
  int append(Eigen::Index vertices) {
    if (index_ < 0) {
      constexpr unsigned char kFirst = 0;
      constexpr float kZeros[3] = {0, 0, 0};
      index_ = append_view(draft_, &kFirst, sizeof kFirst, BufferUse::Other);
      zeros_ = append_view(draft_, kZeros, sizeof kZeros, BufferUse::Other);
    }
    const Json zeros = {0.0, 0.0, 0.0};
    const Json sparse = {{"count", 1},
                         {"indices", {{"bufferView", index_}, {"componentType", kUnsignedByte}}},
                         {"values", {{"bufferView", zeros_}}}};
    return append_accessor(draft_, {{"componentType", kFloatComponent},
                                    {"count", vertices},
                                    {"type", "VEC3"},
                                    {"min", zeros},
                                    {"max", zeros},
                                    {"sparse", sparse}});
  }

  GlbDraft& draft_;
  std::map<Eigen::Index, int> accessors_;
  int index_ = -1, zeros_ = -1;  // bufferViews, one of each a file
};

void append_targets(GlbDraft& draft, NoNormals& no_normals, const PrimitiveMorph& morph,
                    Json& primitive) {
  const bool with_normals = !morph.target_normals.empty();
  if (with_normals && primitive.contains("targets")) {
    for (Json& target : primitive["targets"]) {
      if (target.contains("NORMAL")) continue;
      target["NORMAL"] = no_normals.accessor_of(morph.positions.rows());
    }
  }
  for (std::size_t t = 0; t < morph.target_positions.size(); ++t) {
    Json target = {{"POSITION", append_vectors(draft, morph.target_positions[t])}};
    if (with_normals) target["NORMAL"] = append_vectors(draft, morph.target_normals[t]);
    primitive["targets"].push_back(std::move(target));
  }
}

/// Importers look for names in extras.targetNames. Extras of another kind than an object, which are
/// legal, are kept inside the new object. Own targets without a name get their number.
void name_targets(MorphWriting& writing) {
  Json& extras = mesh_of(writing)["extras"];
  if (!extras.is_null() && !extras.is_object()) extras = Json{{"extras", std::move(extras)}};
  Json& names = extras["targetNames"];
  if (!names.is_array()) names = Json::array();
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
  NoNormals no_normals(writing.draft);
  for (std::size_t p = 0; p < morph.primitives.size(); ++p) {
    append_targets(writing.draft, no_normals, morph.primitives[p], primitives[p]);
  }
  name_targets(writing);
  extend_weights(writing);
}

}  // namespace morphbake
