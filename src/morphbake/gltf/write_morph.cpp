#include "morphbake/gltf/write_morph.h"

#include <fmt/core.h>

#include <array>
#include <cstring>

#include "morphbake/gltf/accessors.h"
#include "morphbake/gltf/glb_draft.h"
#include "morphbake/gltf/source_geometry.h"

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

/// All buffers of the source, one after the other, as buffer 0.
GlbDraft join_buffers(const GltfDocument& document) {
  GlbDraft draft{document.json, {}};
  std::vector<std::size_t> begins;
  for (const tinygltf::Buffer& buffer : document.model.buffers) {
    draft.align();
    begins.push_back(draft.binary.size());
    draft.binary.append(buffer.data.begin(), buffer.data.end());
  }
  for (Json& view : draft.json["bufferViews"]) {
    const std::size_t begin = begins.at(view.at("buffer").get<std::size_t>());
    view["buffer"] = 0;
    if (begin > 0) view["byteOffset"] = begin + view.value("byteOffset", std::size_t{0});
  }
  return draft;
}

/// A .glb stands alone: images in files beside the source, or in data URIs, become bufferViews.
void embed_images(const GltfDocument& document, GlbDraft& draft) {
  if (!draft.json.contains("images")) return;
  for (std::size_t i = 0; i < document.model.images.size(); ++i) {
    Json& image = draft.json["images"][i];
    if (!image.contains("uri")) continue;
    const std::vector<unsigned char>& bytes = document.model.images[i].image;
    const bool is_png = bytes.size() > 4 && std::memcmp(bytes.data(), "\x89PNG", 4) == 0;
    draft.align();
    Json view = {{"buffer", 0}, {"byteOffset", draft.binary.size()}, {"byteLength", bytes.size()}};
    draft.binary.append(bytes.begin(), bytes.end());
    image.erase("uri");
    image["bufferView"] = draft.json["bufferViews"].size();
    image["mimeType"] = is_png ? "image/png" : "image/jpeg";
    draft.json["bufferViews"].push_back(std::move(view));
  }
}

/// Writes `rows` over the elements of an accessor of the source, where they lie.
void overwrite_vectors(const GltfDocument& document, GlbDraft& draft, int accessor,
                       const Float3s& rows) {
  const ElementSpan span = element_span(document, accessor, fmt::format("/accessors/{}", accessor));
  std::size_t begin = span.offset_in_buffer;
  for (int b = 0; b < span.buffer; ++b) {
    begin += (document.model.buffers[static_cast<std::size_t>(b)].data.size() + 3) / 4 * 4;
  }
  for (std::size_t i = 0; i < span.count; ++i) {
    const Float3s::ConstRowXpr row = rows.row(static_cast<Eigen::Index>(i));
    const Eigen::RowVector3f values = row;
    std::memcpy(draft.binary.data() + begin + i * span.stride, values.data(), sizeof(float) * 3);
  }
  Json& entry = draft.json["accessors"][static_cast<std::size_t>(accessor)];
  if (entry.contains("min")) entry["min"] = column_minima(rows);
  if (entry.contains("max")) entry["max"] = column_maxima(rows);
}

void write_primitive(const GltfDocument& document, const PrimitiveMorph& morph, Json& primitive,
                     GlbDraft& draft) {
  const Json attributes = primitive["attributes"];
  overwrite_vectors(document, draft, attributes["POSITION"].get<int>(), morph.positions);
  if (morph.normals.rows() > 0) {
    overwrite_vectors(document, draft, attributes["NORMAL"].get<int>(), morph.normals);
  }
  for (std::size_t t = 0; t < morph.target_positions.size(); ++t) {
    Json target = {{"POSITION", append_vectors(draft, morph.target_positions[t])}};
    if (!morph.target_normals.empty())
      target["NORMAL"] = append_vectors(draft, morph.target_normals[t]);
    primitive["targets"].push_back(std::move(target));
  }
}

void write_animation(const MeshMorph& morph, GlbDraft& draft) {
  const Eigen::Matrix<float, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> weights =
      morph.key_weights;
  const int input = append_scalars(draft, morph.key_times, true);
  const int output = append_scalars(
      draft, std::vector<float>(weights.data(), weights.data() + weights.size()), false);
  const Json target = {{"node", morph.node}, {"path", "weights"}};
  const Json sampler = {{"input", input}, {"output", output}, {"interpolation", "LINEAR"}};
  const Json channel = {{"sampler", 0}, {"target", target}};
  draft.json["animations"].push_back({{"name", morph.animation_name},
                                      {"samplers", Json::array({sampler})},
                                      {"channels", Json::array({channel})}});
}

/// Importers look for names in extras.targetNames. Extras of another kind than an object, which are
/// legal, are kept inside the new object.
void name_targets(Json& mesh, const std::vector<std::string>& names) {
  Json& extras = mesh["extras"];
  if (!extras.is_null() && !extras.is_object()) extras = Json{{"extras", std::move(extras)}};
  extras["targetNames"] = names;
}

}  // namespace

std::string write_morph_glb(const GltfFile& source, const MeshMorph& morph,
                            const std::string& generator) {
  const GltfDocument& document = *source;
  GlbDraft draft = join_buffers(document);
  embed_images(document, draft);
  draft.json["asset"]["generator"] = generator;
  Json& mesh = draft.json["meshes"][static_cast<std::size_t>(morph.mesh)];
  for (std::size_t p = 0; p < morph.primitives.size(); ++p) {
    write_primitive(document, morph.primitives[p], mesh["primitives"][p], draft);
  }
  if (!morph.target_names.empty()) {
    name_targets(mesh, morph.target_names);
    Json weights = Json::array();
    for (Eigen::Index t = 0; t < morph.key_weights.cols(); ++t) {
      weights.push_back(static_cast<double>(morph.key_weights(0, t)));
    }
    mesh["weights"] = std::move(weights);
    write_animation(morph, draft);
  }
  return glb_bytes(draft, document.file);
}

}  // namespace morphbake
