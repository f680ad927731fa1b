#include "morphbake/gltf/unpack.h"

#include <fmt/core.h>

#include <algorithm>
#include <cstring>
#include <map>
#include <set>
#include <utility>

#include "morphbake/gltf/draft_references.h"
#include "morphbake/gltf/packed_parts.h"

namespace morphbake {
namespace {

/// The extension of a bufferView or primitive, or null.
const Json* extension_of(const Json& owner, const char* name) {
  const auto extensions = owner.find("extensions");
  if (extensions == owner.end()) return nullptr;
  const auto found = extensions->find(name);
  return found == extensions->end() ? nullptr : &*found;
}

void erase_extension(Json& owner, const char* name) {
  owner["extensions"].erase(name);
  if (owner["extensions"].empty()) owner.erase("extensions");
}

/// Calls visit(primitive, its pointer) for each primitive of all meshes.
template <typename Root, typename Visit>
void for_each_primitive(Root& json, const Visit& visit) {
  const auto meshes = json.find("meshes");
  for (std::size_t m = 0; meshes != json.end() && m < meshes->size(); ++m) {
    auto& primitives = (*meshes)[m].at("primitives");
    for (std::size_t p = 0; p < primitives.size(); ++p) {
      visit(primitives[p], fmt::format("/meshes/{}/primitives/{}", m, p));
    }
  }
}

/// The JSON of what is being unpacked, and all that it is made from.
struct Unpacking {
  const GltfDocument& document;
  GlbDraft draft;
  UnpackBudget budget;
  References references;
};

/// Bytes of a buffer that are not needed any more; nothing for a buffer that only stands in.
void leave_bytes(Unpacking& at, const Json& range) {
  if (!at.references.are_all) return;
  const auto buffer = range.at("buffer").get<std::size_t>();
  const std::size_t size = at.document.buffers[buffer].size();
  const std::size_t begin = std::min(range.value("byteOffset", std::size_t{0}), size);
  const std::size_t end = begin + std::min(range.at("byteLength").get<std::size_t>(), size - begin);
  const std::size_t first = at.draft.buffer_begins[buffer];
  at.draft.leftovers.bytes.push_back({first + begin, first + end});
}

/// Bytes of a buffer that are compressed.
std::string_view packed_bytes(const Unpacking& at, const Json& range, const std::string& pointer) {
  const auto buffer = range.at("buffer").get<std::size_t>();
  const auto begin = range.value("byteOffset", std::size_t{0});
  const auto length = range.at("byteLength").get<std::size_t>();
  const std::size_t size = at.document.buffers[buffer].size();
  if (begin > size || length > size - begin) {
    fail_at(at.document, pointer, "gltf.invalid",
            fmt::format("bytes {} to {} of buffer {} do not exist; it has {}", begin,
                        begin + length, buffer, size));
  }
  return at.document.buffers[buffer].substr(begin, length);
}

/// Puts bytes at the end of the buffer and lets `view` be them.
void place_bytes(GlbDraft& draft, const std::string& bytes, Json& view) {
  draft.align();
  view["buffer"] = 0;
  view["byteOffset"] = draft.binary.size();
  view["byteLength"] = bytes.size();
  draft.binary += bytes;
}

void unpack_views(Unpacking& at) {
  for (std::size_t v = 0; v < at.draft.views.size(); ++v) {
    Json& view = at.draft.views[v];
    const Json* extension = extension_of(view, kMeshopt);
    if (extension == nullptr) continue;
    const std::string pointer = fmt::format("/bufferViews/{}/extensions/{}", v, kMeshopt);
    const std::string bytes = unpack_meshopt(
        at.document, *extension, packed_bytes(at, *extension, pointer), at.budget, pointer);
    if (bytes.size() != view.at("byteLength").get<std::size_t>()) {
      fail_at(at.document, pointer, "gltf.meshopt",
              fmt::format("unpacked, the bufferView has {} bytes, not {}", bytes.size(),
                          view.at("byteLength").dump()));
    }
    leave_bytes(at, *extension);
    leave_bytes(at, at.document.json["bufferViews"][v]);
    place_bytes(at.draft, bytes, view);
    erase_extension(view, kMeshopt);
  }
}

int columns_of(const std::string& type) {
  if (type == "SCALAR") return 1;
  if (type.starts_with("VEC")) return type[3] - '0';
  return (type[3] - '0') * (type[3] - '0');
}

Json& accessor_at(Unpacking& at, std::size_t index, const std::string& pointer) {
  if (index >= at.draft.accessors.size()) {
    fail_at(at.document, pointer, "gltf.accessor",
            fmt::format("accessor {} does not exist; the file has {}", index,
                        at.draft.accessors.size()));
  }
  return at.draft.accessors[index];
}

PackedAttribute asked_of(const Json& accessor, int id) {
  return {id, accessor.at("componentType").get<int>(),
          columns_of(accessor.at("type").get<std::string>()),
          accessor.at("count").get<std::size_t>()};
}

/// Vertex attributes start at multiples of 4 bytes (glTF 2.0, 3.6.2.4).
std::string padded_rows(const std::string& rows, std::size_t count, std::size_t& stride) {
  const std::size_t width = count > 0 ? rows.size() / count : 0;
  stride = (width + 3) / 4 * 4;
  if (stride == width) return rows;
  std::string padded(count * stride, '\0');
  for (std::size_t i = 0; i < count; ++i) {
    rows.copy(padded.data() + i * stride, width, i * width);
  }
  return padded;
}

/// Decompressed floats may lie a little outside of the bounds that stood there.
void renew_bounds(const std::string& rows, Json& accessor) {
  if (accessor.at("componentType") != kFloatComponent || !accessor.contains("min")) return;
  using Rows = Eigen::Matrix<float, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  const auto count = accessor.at("count").get<Eigen::Index>();
  const int columns = columns_of(accessor.at("type").get<std::string>());
  Rows numbers(count, columns);
  std::memcpy(numbers.data(), rows.data(), rows.size());
  accessor["min"] = column_minima(numbers);
  accessor["max"] = column_maxima(numbers);
}

/// Lets an accessor be the numbers of a new bufferView.
void give_rows(Unpacking& at, const std::string& rows, Json& accessor) {
  const auto count = accessor.at("count").get<std::size_t>();
  std::size_t stride = 0;
  const std::string padded = padded_rows(rows, count, stride);
  const int view =
      replace_view(at.draft, at.references, release_views(at.draft, at.references, accessor),
                   append_bytes(at.draft, padded.data(), padded.size(), BufferUse::Vertices));
  if (padded.size() != rows.size()) {
    at.draft.views[static_cast<std::size_t>(view)]["byteStride"] = stride;
  }
  accessor["bufferView"] = view;
  accessor.erase("byteOffset");
  accessor.erase("sparse");
  renew_bounds(rows, accessor);
}

/// Lets the accessor of a primitive's indices be these, in the bufferView that was compressed: so
/// no bufferView is left over.
void give_indices(Unpacking& at, const std::vector<std::uint32_t>& indices, std::size_t view,
                  Json& accessor) {
  const int type = accessor.at("componentType").get<int>();
  const std::size_t width = type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT     ? 4
                            : type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT ? 2
                                                                             : 1;
  std::string bytes(indices.size() * width, '\0');
  for (std::size_t i = 0; i < indices.size(); ++i) {
    std::memcpy(bytes.data() + i * width, &indices[i], width);
  }
  release_views(at.draft, at.references, accessor);
  place_bytes(at.draft, bytes, at.draft.views[view]);
  at.draft.views[view]["target"] = 34963;  // ELEMENT_ARRAY_BUFFER
  accessor["bufferView"] = view;
  accessor.erase("byteOffset");
  accessor.erase("sparse");
  for (const char* bound : {"min", "max"}) accessor.erase(bound);  // of indices none are needed
}

/// A JSON object finds its fields one by one, which takes forever in one with many.
std::map<std::string, std::size_t> accessors_by_name(const Json& attributes) {
  std::map<std::string, std::size_t> accessors;
  for (const auto& [name, accessor] : attributes.items()) {
    accessors.emplace(name, accessor.get<std::size_t>());
  }
  return accessors;
}

void unpack_primitive(Unpacking& at, Json& primitive, const std::string& owner,
                      std::set<std::size_t>& reused) {
  const Json* found = extension_of(primitive, kDraco);
  if (found == nullptr) return;
  const Json extension = *found;
  const std::string pointer = fmt::format("{}/extensions/{}", owner, kDraco);
  const auto view = extension.at("bufferView").get<std::size_t>();
  const auto views = at.document.json.find("bufferViews");
  if (views == at.document.json.end() || view >= views->size() || !primitive.contains("indices")) {
    fail_at(at.document, pointer, "gltf.invalid",
            "compressed primitives need a bufferView and indices");
  }
  std::vector<PackedAttribute> asked;
  std::vector<std::size_t> accessors;
  const std::map<std::string, std::size_t> own = accessors_by_name(primitive.at("attributes"));
  for (const auto& [name, id] : extension.at("attributes").items()) {
    const auto attribute = own.find(name);
    if (attribute == own.end()) {
      fail_at(at.document, child_pointer(pointer + "/attributes", name), "gltf.invalid",
              "the primitive itself has no such attribute");
    }
    accessors.push_back(attribute->second);
    asked.push_back(
        asked_of(accessor_at(at, accessors.back(), child_pointer(owner + "/attributes", name)),
                 static_cast<int>(std::min<std::int64_t>(id.get<std::int64_t>(), INT32_MAX))));
  }
  Json& indices = accessor_at(at, primitive["indices"].get<std::size_t>(), owner + "/indices");
  const UnpackedPrimitive unpacked =
      unpack_draco(at.document, packed_bytes(at, (*views)[view], pointer),
                   indices.at("count").get<std::size_t>(), asked, at.budget, pointer);
  leave_bytes(at, (*views)[view]);
  for (std::size_t a = 0; a < accessors.size(); ++a) {
    give_rows(at, unpacked.attributes[a], at.draft.accessors[accessors[a]]);
  }
  std::size_t place = view;
  if (!reused.insert(view).second) {  // several primitives in one bufferView
    place = at.draft.views.size();
    at.draft.views.push_back(Json::object());
  }
  give_indices(at, unpacked.indices, place, indices);
  erase_extension(primitive, kDraco);
}

/// Takes a name out of extensionsUsed and extensionsRequired.
void erase_name(Json& json, const char* list, const char* name) {
  const auto found = json.find(list);
  if (found == json.end()) return;
  found->erase(std::remove(found->begin(), found->end(), Json(name)), found->end());
  if (found->empty()) json.erase(list);
}

/// The JSON of a file whose buffers stand for no compressed data any more.
Json without_marks(Json json) {
  for (const char* list : {"extensionsUsed", "extensionsRequired"}) {
    for (const char* name : {kMeshopt, kDraco}) erase_name(json, list, name);
  }
  const auto buffers = json.find("buffers");
  if (buffers == json.end()) return json;
  for (Json& buffer : *buffers) {
    if (extension_of(buffer, kMeshopt) != nullptr) erase_extension(buffer, kMeshopt);
  }
  return json;
}

}  // namespace

bool is_packed(const Json& json) {
  bool found = false;
  const auto views = json.find("bufferViews");
  for (std::size_t v = 0; views != json.end() && v < views->size(); ++v) {
    found = found || extension_of((*views)[v], kMeshopt) != nullptr;
  }
  for_each_primitive(json, [&](const Json& primitive, const std::string&) {
    found = found || extension_of(primitive, kDraco) != nullptr;
  });
  return found;
}

std::string unpacked_glb(const GltfDocument& document) {
  std::size_t bytes = 0;
  for (const std::string_view buffer : document.buffers) bytes += buffer.size();
  Unpacking at{document,
               join_buffers(without_marks(document.json), document.buffers),
               UnpackBudget::of_file(bytes),
               {}};
  at.references = references_in(at.draft);
  unpack_views(at);
  std::set<std::size_t> reused;
  for_each_primitive(at.draft.json, [&](Json& primitive, const std::string& pointer) {
    unpack_primitive(at, primitive, pointer, reused);
  });
  remove_leftovers(at.draft);
  at.draft.shown = document.file;
  return glb_bytes(at.draft);
}

}  // namespace morphbake
