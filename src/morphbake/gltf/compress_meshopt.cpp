#include "morphbake/gltf/compress_meshopt.h"

#include <meshoptimizer.h>

#include <algorithm>
#include <cstring>
#include <optional>
#include <utility>
#include <vector>

#include "morphbake/gltf/accessors.h"
#include "morphbake/gltf/draft_references.h"
#include "morphbake/gltf/packed_parts.h"

namespace morphbake {
namespace {

constexpr std::size_t kLargestStride = 256;

/// How a bufferView may be compressed.
struct Packing {
  const char* mode = "ATTRIBUTES";
  std::size_t stride = 0;
};

/// What accessors say of a bufferView.
struct ViewUse {
  int references = 0;         ///< by accessors
  std::size_t element = 0;    ///< bytes; of all of them
  bool differs = false;       ///< in that
  bool is_triangles = false;  ///< indices of triangle lists
  bool is_indices = false;    ///< indices of anything
  bool is_numbers = false;    ///< anything else
};

void note_use(ViewUse& use, std::size_t element) {
  ++use.references;
  use.differs = use.differs || (use.element != 0 && use.element != element);
  use.element = element;
}

/// Accessors that are indices of triangle lists with whole triangles, and of anything else.
struct IndexAccessors {
  std::vector<bool> triangles, others;
};

IndexAccessors index_accessors(const GlbDraft& draft) {
  IndexAccessors found{std::vector<bool>(draft.accessors.size()),
                       std::vector<bool>(draft.accessors.size())};
  if (!draft.json.contains("meshes")) return found;
  for (const Json& mesh : draft.json["meshes"]) {
    for (const Json& primitive : mesh.at("primitives")) {
      if (!primitive.contains("indices")) continue;
      const auto accessor = primitive["indices"].get<std::size_t>();
      const auto count = draft.accessors.at(accessor).at("count").get<std::size_t>();
      const bool is_list = primitive.value("mode", 4) == 4 && count % 3 == 0;
      (is_list ? found.triangles : found.others)[accessor] = true;
    }
  }
  return found;
}

std::vector<ViewUse> uses_of(const GlbDraft& draft) {
  std::vector<ViewUse> uses(draft.views.size());
  const IndexAccessors indices = index_accessors(draft);
  for (std::size_t a = 0; a < draft.accessors.size(); ++a) {
    const Json& accessor = draft.accessors[a];
    const std::size_t element = component_bytes(accessor.at("componentType").get<int>()) *
                                components_of(accessor.at("type").get<std::string>());
    if (accessor.contains("bufferView")) {
      ViewUse& use = uses.at(accessor["bufferView"].get<std::size_t>());
      note_use(use, element);
      use.is_triangles = use.is_triangles || indices.triangles[a];
      use.is_indices = use.is_indices || indices.others[a];
      use.is_numbers = use.is_numbers || !(indices.triangles[a] || indices.others[a]);
    }
    if (!accessor.contains("sparse")) continue;
    const Json& sparse = accessor["sparse"];
    ViewUse& at = uses.at(sparse.at("indices").at("bufferView").get<std::size_t>());
    note_use(at, component_bytes(sparse["indices"].at("componentType").get<int>()));
    at.is_indices = true;
    ViewUse& values = uses.at(sparse.at("values").at("bufferView").get<std::size_t>());
    note_use(values, element);
    values.is_numbers = true;
  }
  return uses;
}

std::optional<Packing> packing_of(const ViewUse& use, const Json& view, int references) {
  if (use.references == 0 || use.references != references || use.differs) return {};
  if (view.contains("extensions")) return {};
  const std::size_t stride = view.value("byteStride", use.element);
  const auto length = view.at("byteLength").get<std::size_t>();
  if (length == 0 || length % stride != 0) return {};
  if (use.is_triangles || use.is_indices) {
    if (use.is_numbers || (stride != 2 && stride != 4)) return {};
    return Packing{use.is_indices ? "INDICES" : "TRIANGLES", stride};
  }
  if (stride % 4 != 0 || stride > kLargestStride) return {};
  return Packing{"ATTRIBUTES", stride};
}

std::vector<std::uint32_t> indices_in(std::string_view bytes, std::size_t stride) {
  std::vector<std::uint32_t> indices(bytes.size() / stride);
  for (std::size_t i = 0; i < indices.size(); ++i) {
    std::memcpy(&indices[i], bytes.data() + i * stride, stride);  // little-endian as the file
  }
  return indices;
}

std::string packed(const Packing& packing, std::string_view bytes) {
  const std::size_t count = bytes.size() / packing.stride;
  const std::string_view mode = packing.mode;
  std::string to;
  const auto out = [&](std::size_t bound) {
    to.resize(bound);
    return reinterpret_cast<unsigned char*>(to.data());
  };
  if (mode == "ATTRIBUTES") {
    const std::size_t bound = meshopt_encodeVertexBufferBound(count, packing.stride);
    auto* const data = out(bound);
    to.resize(meshopt_encodeVertexBuffer(data, bound, bytes.data(), count, packing.stride));
    return to;
  }
  const std::vector<std::uint32_t> indices = indices_in(bytes, packing.stride);
  const std::size_t vertices = std::size_t{*std::max_element(indices.begin(), indices.end())} + 1;
  const bool is_triangles = mode == "TRIANGLES";
  const std::size_t bound = is_triangles ? meshopt_encodeIndexBufferBound(count, vertices)
                                         : meshopt_encodeIndexSequenceBound(count, vertices);
  auto* const data = out(bound);
  to.resize(is_triangles ? meshopt_encodeIndexBuffer(data, bound, indices.data(), count)
                         : meshopt_encodeIndexSequence(data, bound, indices.data(), count));
  return to;
}

}  // namespace

std::string compress_meshopt(const GltfFile& file) {
  const GltfDocument& document = *file;
  // What the extension's decoders of 2020 read, which is all that clients promise.
  meshopt_encodeVertexVersion(0);
  meshopt_encodeIndexVersion(1);
  GlbDraft draft = join_buffers(document.json, document.buffers);
  draft.shown = document.file;
  const std::string binary = std::move(draft.binary);
  draft.binary.clear();
  const References references = references_in(draft);
  const std::vector<ViewUse> uses = uses_of(draft);
  for (std::size_t v = 0; v < draft.views.size(); ++v) {
    Json& view = draft.views[v];
    const std::string_view bytes = std::string_view(binary).substr(
        view.value("byteOffset", std::size_t{0}), view.at("byteLength"));
    const std::optional<Packing> packing = packing_of(uses[v], view, references.views[v]);
    const std::string small = packing ? packed(*packing, bytes) : std::string();
    if (small.empty() || small.size() >= bytes.size()) {
      view["byteOffset"] =
          append_bytes(draft, bytes.data(), bytes.size(), BufferUse::Other).at("byteOffset");
      continue;
    }
    Json extension = append_bytes(draft, small.data(), small.size(), BufferUse::Other);
    extension["byteStride"] = packing->stride;
    extension["count"] = bytes.size() / packing->stride;
    extension["mode"] = packing->mode;
    view["buffer"] = 1;
    view["byteOffset"] = draft.fallback_bytes;
    view["extensions"][kMeshopt] = std::move(extension);
    draft.fallback_bytes += (bytes.size() + 3) / 4 * 4;
  }
  if (draft.fallback_bytes > 0) require_extension(draft.json, kMeshopt);
  return glb_bytes(draft);
}

}  // namespace morphbake
