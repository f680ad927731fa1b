#include "morphbake/gltf/write_morph.h"

#include <fmt/core.h>

#include <algorithm>
#include <set>
#include <string_view>
#include <utility>

#include "morphbake/gltf/morph_writing.h"
#include "morphbake/gltf/primitive_geometry.h"

namespace morphbake {
namespace {

constexpr std::size_t kMostNameBytes = 63;  // Blender cuts names there

/// Whether a byte of UTF-8 goes on with the character before it.
bool is_continued(char byte) { return (static_cast<unsigned char>(byte) & 0xC0U) == 0x80U; }

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

/// A part of the timeline: own targets stay at rest.
void append_animation(MorphWriting& writing, const MorphClip& clip) {
  const auto own = static_cast<Eigen::Index>(writing.own_targets);
  Eigen::Matrix<float, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> weights(
      clip.key_weights.rows(), own + clip.key_weights.cols());
  weights.leftCols(own).rowwise() = own_weights(writing).transpose().cast<float>();
  weights.rightCols(clip.key_weights.cols()) = clip.key_weights;
  const int input = append_scalars(writing.draft, clip.key_times, true);
  const int output = append_scalars(
      writing.draft, std::vector<float>(weights.data(), weights.data() + weights.size()), false);
  const Json target = {{"node", writing.morph.node}, {"path", "weights"}};
  const Json sampler = {{"input", input}, {"output", output}, {"interpolation", "LINEAR"}};
  const Json channel = {{"sampler", 0}, {"target", target}};
  Json& animations = writing.draft.json["animations"];
  std::set<std::string> taken;
  for (const Json& animation : animations) {
    const auto name = animation.find("name");
    if (name != animation.end() && name->is_string()) taken.insert(name->get<std::string>());
  }
  animations.push_back({{"name", free_name(clip.name, taken)},
                        {"samplers", Json::array({sampler})},
                        {"channels", Json::array({channel})}});
}

GlbDraft draft_of(const GltfDocument& document) {
  GlbDraft draft = join_buffers(document.json, document.buffers);
  draft.shown = document.file;
  return draft;
}

}  // namespace

Json& mesh_of(MorphWriting& writing) {
  return writing.draft.json["meshes"][static_cast<std::size_t>(writing.mesh)];
}

Eigen::VectorXd own_weights(const MorphWriting& writing) {
  const tinygltf::Model& model = writing.document.model;
  return rest_weights(model.nodes[static_cast<std::size_t>(writing.morph.node)],
                      model.meshes[static_cast<std::size_t>(writing.morph.mesh)],
                      writing.own_targets);
}

std::vector<float> first_weights(const MeshMorph& morph) {
  const Eigen::VectorXf row = morph.clips.front().key_weights.row(0);
  return {row.data(), row.data() + row.size()};
}

std::string free_name(const std::string& name, const std::set<std::string>& taken) {
  std::string free = name;
  for (int i = 2; taken.contains(free); ++i) {
    const std::string number = fmt::format("-{}", i);
    std::size_t kept = std::min(name.size(), kMostNameBytes - number.size());
    while (kept > 0 && kept < name.size() && is_continued(name[kept])) --kept;
    free = name.substr(0, kept) + number;
  }
  return free;
}

std::string write_morph_glb(const GltfFile& source, const MeshMorph& morph,
                            const std::string& generator) {
  const GltfDocument& document = *source;
  MorphWriting writing{document,           morph, target_count(document, morph.mesh), morph.mesh,
                       draft_of(document), {}};
  GlbDraft& draft = writing.draft;
  embed_images(document, draft);
  draft.json["asset"]["generator"] = generator;
  if (morph.drops_skin) separate_posed_mesh(writing);
  writing.references = references_in(draft);
  if (morph.drops_skin) drop_skin(writing);
  if (morph.replaces_base) place_base(writing);
  place_colours(writing);
  if (!morph.target_names.empty()) {
    extend_animations(writing);
    place_targets(writing);
    for (const MorphClip& clip : morph.clips) append_animation(writing, clip);
  }
  remove_leftovers(draft);
  return glb_bytes(draft);
}

}  // namespace morphbake
