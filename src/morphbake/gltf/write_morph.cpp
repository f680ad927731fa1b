#include "morphbake/gltf/write_morph.h"

#include <fmt/core.h>

#include <algorithm>
#include <map>
#include <string_view>
#include <utility>

#include "morphbake/gltf/accessors.h"
#include "morphbake/gltf/animation_curve.h"
#include "morphbake/gltf/glb_draft.h"
#include "morphbake/gltf/primitive_geometry.h"
#include "morphbake/gltf/replace_accessor.h"

namespace morphbake {
namespace {

int append_scalars(GlbDraft& draft, const std::vector<float>& values, bool bounded) {
  const int view =
      append_view(draft, values.data(), values.size() * sizeof(float), BufferUse::Other);
  Json accessor = {{"bufferView", view},
                   {"componentType", kFloatComponent},
                   {"count", values.size()},
                   {"type", "SCALAR"}};
  if (bounded) {
    const Eigen::Map<const Eigen::VectorXf> column(values.data(),
                                                   static_cast<Eigen::Index>(values.size()));
    accessor["min"] = column_minima(column);
    accessor["max"] = column_maxima(column);
  }
  return append_accessor(draft, std::move(accessor));
}

/// A .glb stands alone: images in files beside the source, or in data URIs, become bufferViews.
void embed_images(const GltfDocument& document, GlbDraft& draft) {
  const auto images = draft.json.find("images");
  if (images == draft.json.end()) return;
  for (std::size_t i = 0; i < document.model.images.size(); ++i) {
    Json& image = (*images)[i];
    if (!image.contains("uri")) continue;
    const std::vector<unsigned char>& bytes = document.model.images[i].image;
    image.erase("uri");
    image["bufferView"] = append_view(draft, bytes.data(), bytes.size(), BufferUse::Other);
    image["mimeType"] = document.model.images[i].mimeType;
  }
}

/// What is written, and from what.
struct Writing {
  const GltfDocument& document;
  const MeshMorph& morph;
  std::size_t own_targets = 0;  ///< of the mesh as the file has it
  GlbDraft draft;
  References references;  ///< before anything was added
};

Json& mesh_of(Writing& writing) {
  return writing.draft.json["meshes"][static_cast<std::size_t>(writing.morph.mesh)];
}

/// Weights of the mesh's own targets at rest.
Eigen::VectorXd own_weights(const Writing& writing) {
  const tinygltf::Model& model = writing.document.model;
  return rest_weights(model.nodes[static_cast<std::size_t>(writing.morph.node)],
                      model.meshes[static_cast<std::size_t>(writing.morph.mesh)],
                      writing.own_targets);
}

/// One attribute of the mesh's primitives: its accessors, and new rows for them.
struct NewAttribute {
  std::string name;
  std::vector<Float3s> rows;  ///< one a primitive; none: stays
};

/// Primitives may share an accessor, of which each moves the vertices that it uses: a vertex is
/// where the primitive that moves it puts it.
void replace_attribute(Writing& writing, const NewAttribute& attribute) {
  Json& primitives = mesh_of(writing)["primitives"];
  std::map<int, std::vector<std::size_t>> sharing;  // accessor -> primitives
  for (std::size_t p = 0; p < primitives.size(); ++p) {
    const Json& attributes = primitives[p]["attributes"];
    if (attribute.rows[p].rows() > 0 && attributes.contains(attribute.name)) {
      sharing[attributes[attribute.name].get<int>()].push_back(p);
    }
  }
  for (const auto& [old, users] : sharing) {
    const Float3s before = read_float3s(writing.document, old, fmt::format("/accessors/{}", old));
    Float3s after = attribute.rows[users.front()];
    for (const std::size_t p : users) {
      const Float3s& rows = attribute.rows[p];
      for (Eigen::Index r = 0; r < after.rows(); ++r) {
        if (rows.row(r) != before.row(r)) after.row(r) = rows.row(r);
      }
    }
    const int written =
        replace_accessor(writing.draft, writing.references, {old, static_cast<int>(users.size())},
                         {after.data(), static_cast<std::size_t>(after.rows()), 3});
    for (const std::size_t p : users) primitives[p]["attributes"][attribute.name] = written;
  }
}

/// Base shape that shows `primitive` when the mesh's own targets have their weights at rest.
void replace_base(Writing& writing) {
  const GltfDocument& document = writing.document;
  const MeshMorph& morph = writing.morph;
  const std::size_t own_targets = writing.own_targets;
  const tinygltf::Mesh& mesh = document.model.meshes[static_cast<std::size_t>(morph.mesh)];
  const Eigen::VectorXd rest = own_weights(writing);
  NewAttribute positions{"POSITION", {}}, normals{"NORMAL", {}};
  for (std::size_t p = 0; p < morph.primitives.size(); ++p) {
    const PrimitiveMorph& primitive = morph.primitives[p];
    positions.rows.push_back(primitive.positions);
    normals.rows.push_back(primitive.normals);
    for (std::size_t t = 0; t < own_targets; ++t) {
      const auto weight = static_cast<float>(rest(static_cast<Eigen::Index>(t)));
      if (weight == 0) continue;
      const TargetGeometry target =
          read_target(document, mesh.primitives[p], t, primitive.positions.rows(),
                      primitive_pointer(morph.mesh, p));
      if (target.positions.rows() > 0) positions.rows[p] -= weight * target.positions;
      if (target.normals.rows() > 0 && primitive.normals.rows() > 0) {
        normals.rows[p] -= weight * target.normals;
      }
    }
  }
  replace_attribute(writing, positions);
  replace_attribute(writing, normals);
}

/// Normal displacements of a target that has none: 0 without a bufferView. three.js takes the base
/// normals for them where only some targets have NORMAL.
int append_no_normals(GlbDraft& draft, Eigen::Index vertices) {
  const Json zeros = {0.0, 0.0, 0.0};
  return append_accessor(draft, {{"componentType", kFloatComponent},
                                 {"count", vertices},
                                 {"type", "VEC3"},
                                 {"min", zeros},
                                 {"max", zeros}});
}

void append_targets(Writing& writing, const PrimitiveMorph& morph, Json& primitive) {
  GlbDraft& draft = writing.draft;
  const bool with_normals = !morph.target_normals.empty();
  if (with_normals && primitive.contains("targets")) {
    for (Json& target : primitive["targets"]) {
      if (target.contains("NORMAL")) continue;
      target["NORMAL"] = append_no_normals(draft, morph.positions.rows());
    }
  }
  for (std::size_t t = 0; t < morph.target_positions.size(); ++t) {
    Json target = {{"POSITION", append_vectors(draft, morph.target_positions[t])}};
    if (with_normals) target["NORMAL"] = append_vectors(draft, morph.target_normals[t]);
    primitive["targets"].push_back(std::move(target));
  }
}

/// Weights of the new targets where nothing moves them.
std::vector<float> first_weights(const MeshMorph& morph) {
  const Eigen::VectorXf row = morph.key_weights.row(0);
  return {row.data(), row.data() + row.size()};
}

void append_weights(const MeshMorph& morph, Json& weights) {
  for (const float weight : first_weights(morph)) weights.push_back(static_cast<double>(weight));
}

/// Importers look for names in extras.targetNames. Extras of another kind than an object, which are
/// legal, are kept inside the new object. Own targets without a name get their number.
void name_targets(Writing& writing) {
  Json& extras = mesh_of(writing)["extras"];
  if (!extras.is_null() && !extras.is_object()) extras = Json{{"extras", std::move(extras)}};
  Json& names = extras["targetNames"];
  if (!names.is_array()) names = Json::array();
  names.get_ref<Json::array_t&>().resize(std::min(names.size(), writing.own_targets));
  while (names.size() < writing.own_targets) names.push_back(std::to_string(names.size()));
  for (const std::string& name : writing.morph.target_names) names.push_back(name);
}

/// Weights of mesh and nodes have one number a target.
void extend_weights(Writing& writing) {
  const auto mesh_index = static_cast<std::size_t>(writing.morph.mesh);
  Json& mesh = mesh_of(writing);
  Json& weights = mesh["weights"];
  if (!weights.is_array()) weights = Json::array();
  weights.get_ref<Json::array_t&>().resize(writing.own_targets, 0.0);
  append_weights(writing.morph, weights);
  for (Json& node : writing.draft.json["nodes"]) {
    if (!node.contains("mesh") || node["mesh"] != mesh_index || !node.contains("weights")) continue;
    node["weights"].get_ref<Json::array_t&>().resize(writing.own_targets, 0.0);
    append_weights(writing.morph, node["weights"]);
  }
}

/// The numbers of a weights curve with the new targets' after those of each key.
std::vector<float> extended(const AnimationCurve& curve, const std::vector<float>& added) {
  std::vector<float> numbers;
  const auto append = [&](const Eigen::MatrixXf& rows, Eigen::Index key, bool is_value) {
    for (Eigen::Index t = 0; t < rows.cols(); ++t) numbers.push_back(rows(key, t));
    for (const float weight : added) numbers.push_back(is_value ? weight : 0.0F);
  };
  const bool is_cubic = curve.interpolation == Interpolation::CubicSpline;
  for (Eigen::Index key = 0; key < curve.values.rows(); ++key) {
    if (is_cubic) append(curve.in_tangents, key, false);
    append(curve.values, key, true);
    if (is_cubic) append(curve.out_tangents, key, false);
  }
  return numbers;
}

/// Whether a channel moves the weights of the morph's mesh.
bool moves_mesh(const GltfDocument& document, const Json& channel, int mesh) {
  const Json& target = channel.at("target");
  if (!target.contains("node") || target.at("path") != "weights") return false;
  const auto node = target["node"].get<std::size_t>();
  return node < document.model.nodes.size() && document.model.nodes[node].mesh == mesh;
}

/// Own animations of the mesh's weights get numbers for the new targets.
void extend_animation(Writing& writing, int index) {
  const GltfDocument& document = writing.document;
  const MeshMorph& morph = writing.morph;
  const std::size_t own_targets = writing.own_targets;
  Json& animation = writing.draft.json["animations"][static_cast<std::size_t>(index)];
  std::map<std::size_t, std::size_t> channels;  // sampler -> channels of any kind
  for (const Json& channel : animation["channels"]) {
    ++channels[channel.at("sampler").get<std::size_t>()];
  }
  std::map<std::size_t, std::size_t> extended_samplers;  // old -> extended
  for (Json& channel : animation["channels"]) {
    if (!moves_mesh(document, channel, morph.mesh)) continue;
    if (own_targets == 0) {
      fail_at(document, fmt::format("/animations/{}", index), "gltf.invalid",
              "the animation moves weights of a mesh that has no morph targets",
              "export the file again, or without that animation");
    }
    const auto old = channel["sampler"].get<std::size_t>();
    if (old >= animation["samplers"].size()) {
      fail_at(document, fmt::format("/animations/{}/samplers/{}", index, old), "gltf.invalid",
              "the sampler does not exist");
    }
    if (const auto done = extended_samplers.find(old); done != extended_samplers.end()) {
      channel["sampler"] = done->second;
      continue;
    }
    const auto users = static_cast<std::size_t>(
        std::ranges::count_if(animation["channels"], [&, mesh = morph.mesh](const Json& other) {
          return other.at("sampler") == old && moves_mesh(document, other, mesh);
        }));
    const AnimationCurve curve =
        read_curve(document, index, static_cast<int>(old), static_cast<int>(own_targets));
    const std::vector<float> numbers = extended(curve, first_weights(morph));
    Json sampler = animation["samplers"][old];
    const int output = sampler["output"].get<int>();
    const bool is_ours = users == channels[old];
    sampler["output"] =
        replace_accessor(writing.draft, writing.references, {output, is_ours ? 1 : 0},
                         {numbers.data(), numbers.size(), 1, BufferUse::Other});
    std::size_t place = old;
    if (is_ours) {
      animation["samplers"][old] = std::move(sampler);
    } else {
      place = animation["samplers"].size();
      animation["samplers"].push_back(std::move(sampler));
    }
    extended_samplers[old] = place;
    channel["sampler"] = place;
  }
}

/// The timeline: own targets stay at rest.
void append_animation(Writing& writing) {
  const MeshMorph& morph = writing.morph;
  const auto own = static_cast<Eigen::Index>(writing.own_targets);
  Eigen::Matrix<float, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> weights(
      morph.key_weights.rows(), own + morph.key_weights.cols());
  weights.leftCols(own).rowwise() = own_weights(writing).transpose().cast<float>();
  weights.rightCols(morph.key_weights.cols()) = morph.key_weights;
  const int input = append_scalars(writing.draft, morph.key_times, true);
  const int output = append_scalars(
      writing.draft, std::vector<float>(weights.data(), weights.data() + weights.size()), false);
  const Json target = {{"node", morph.node}, {"path", "weights"}};
  const Json sampler = {{"input", input}, {"output", output}, {"interpolation", "LINEAR"}};
  const Json channel = {{"sampler", 0}, {"target", target}};
  writing.draft.json["animations"].push_back({{"name", morph.animation_name},
                                              {"samplers", Json::array({sampler})},
                                              {"channels", Json::array({channel})}});
}

GlbDraft draft_of(const GltfDocument& document) {
  std::vector<std::string_view> buffers;
  for (const tinygltf::Buffer& buffer : document.model.buffers) {
    buffers.emplace_back(reinterpret_cast<const char*>(buffer.data.data()), buffer.data.size());
  }
  return join_buffers(document.json, buffers);
}

}  // namespace

std::string write_morph_glb(const GltfFile& source, const MeshMorph& morph,
                            const std::string& generator) {
  const GltfDocument& document = *source;
  Writing writing{document, morph, target_count(document, morph.mesh), draft_of(document), {}};
  GlbDraft& draft = writing.draft;
  embed_images(document, draft);
  writing.references = references_in(draft);
  draft.json["asset"]["generator"] = generator;
  if (morph.replaces_base) replace_base(writing);
  if (morph.drops_skin) {
    draft.json["nodes"][static_cast<std::size_t>(morph.node)].erase("skin");
  }
  if (!morph.target_names.empty()) {
    Json& primitives = mesh_of(writing)["primitives"];
    for (std::size_t p = 0; p < morph.primitives.size(); ++p) {
      append_targets(writing, morph.primitives[p], primitives[p]);
    }
    name_targets(writing);
    extend_weights(writing);
    for (std::size_t a = 0; a < document.model.animations.size(); ++a) {
      extend_animation(writing, static_cast<int>(a));
    }
    append_animation(writing);
  }
  return glb_bytes(draft, document.file);
}

}  // namespace morphbake
