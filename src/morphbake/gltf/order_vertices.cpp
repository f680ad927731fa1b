#include "morphbake/gltf/order_vertices.h"

#include <meshoptimizer.h>

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <map>
#include <utility>

#include "morphbake/gltf/accessors.h"
#include "morphbake/gltf/displacements.h"
#include "morphbake/gltf/draft_references.h"

namespace morphbake {
namespace {

constexpr std::uint32_t kUnused = ~std::uint32_t{0};

/// A mesh on its way to another order.
struct Ordering {
  const GltfDocument& document;
  GlbDraft draft;
  References references;
};

/// Attributes of the primitive and of its targets.
std::vector<Json*> attribute_sets(Json& primitive) {
  std::vector<Json*> sets{&primitive["attributes"]};
  if (!primitive.contains("targets")) return sets;
  for (Json& target : primitive["targets"]) sets.push_back(&target);
  return sets;
}

/// How often a primitive refers to each accessor.
std::map<int, int> uses_in(Json& primitive) {
  std::map<int, int> uses;
  for (const Json* set : attribute_sets(primitive)) {
    for (const auto& [name, accessor] : set->items()) ++uses[accessor.get<int>()];
  }
  return uses;
}

bool is_zero(const Json& accessor) {  // as Displacements write it
  return accessor.contains("sparse") && !accessor.contains("bufferView") &&
         accessor["sparse"].at("count") == 1 && accessor.contains("min") &&
         accessor["min"] == accessor["max"];
}

/// Whether the primitive's vertices are its own, but for zeros, which have no order.
bool may_be_ordered(const Ordering& work, Json& primitive) {
  if (primitive.value("mode", 4) != 4 || !primitive.contains("indices")) return false;
  if (work.references.accessors.at(primitive["indices"].get<std::size_t>()) != 1) return false;
  for (const auto& [accessor, count] : uses_in(primitive)) {
    const auto at = static_cast<std::size_t>(accessor);
    if (is_zero(work.draft.accessors[at])) continue;
    if (work.references.accessors.at(at) != count) return false;
  }
  return true;
}

std::vector<std::uint32_t> indices_of(const Ordering& work, int accessor, std::size_t vertices) {
  const std::string pointer = child_pointer("/accessors", static_cast<std::size_t>(accessor));
  std::vector<int> numbers(index_count(work.document, accessor, pointer));
  read_indices(work.document, accessor, vertices, pointer, numbers);
  return {numbers.begin(), numbers.end()};
}

/// The new number of each vertex: in the order of their first use, those without any at the end.
std::vector<std::uint32_t> new_numbers(const std::vector<std::uint32_t>& indices,
                                       std::size_t vertices) {
  std::vector<std::uint32_t> number(vertices);
  auto used = static_cast<std::uint32_t>(
      meshopt_optimizeVertexFetchRemap(number.data(), indices.data(), indices.size(), vertices));
  for (std::uint32_t& each : number) {
    if (each == kUnused) each = used++;
  }
  return number;
}

/// Elements of an accessor, or what is told of a part of it.
struct Elements {
  std::size_t bytes = 0;  ///< of one
  std::string values;
};

Elements elements_of(const Ordering& work, const Json& holder, std::size_t bytes,
                     std::size_t count) {
  const Json& view = work.draft.views[holder.at("bufferView").get<std::size_t>()];
  const std::size_t stride = view.value("byteStride", bytes);
  const std::size_t begin =
      view.value("byteOffset", std::size_t{0}) + holder.value("byteOffset", std::size_t{0});
  Elements elements{bytes, std::string(bytes * count, '\0')};
  for (std::size_t i = 0; i < count; ++i) {
    std::memcpy(&elements.values[i * bytes], &work.draft.binary[begin + i * stride], bytes);
  }
  return elements;
}

/// A view of elements, at multiples of 4 bytes where vertices are read from it.
Json dense_view(GlbDraft& draft, const Elements& elements) {
  const std::size_t stride = (elements.bytes + 3) / 4 * 4;
  const std::size_t count = elements.values.size() / elements.bytes;
  std::string padded(stride * count, '\0');
  for (std::size_t i = 0; i < count; ++i) {
    std::memcpy(&padded[i * stride], &elements.values[i * elements.bytes], elements.bytes);
  }
  Json view = append_bytes(draft, padded.data(), padded.size(), BufferUse::Vertices);
  if (stride != elements.bytes) view["byteStride"] = stride;
  return view;
}

Json ordered_dense(Ordering& work, Json accessor, std::size_t bytes,
                   const std::vector<std::uint32_t>& number) {
  const Elements old = elements_of(work, accessor, bytes, number.size());
  Elements ordered{bytes, std::string(old.values.size(), '\0')};
  for (std::size_t v = 0; v < number.size(); ++v) {
    std::memcpy(&ordered.values[number[v] * bytes], &old.values[v * bytes], bytes);
  }
  accessor["bufferView"] = add_view(work.draft, dense_view(work.draft, ordered));
  accessor.erase("byteOffset");
  return accessor;
}

Json ordered_sparse(Ordering& work, Json accessor, std::size_t bytes,
                    const std::vector<std::uint32_t>& number) {
  const Json& sparse = accessor["sparse"];
  const auto count = sparse.at("count").get<std::size_t>();
  const std::size_t index_bytes = component_bytes(sparse["indices"].at("componentType").get<int>());
  const Elements at = elements_of(work, sparse["indices"], index_bytes, count);
  const Elements values = elements_of(work, sparse["values"], bytes, count);
  std::vector<std::pair<std::uint32_t, std::size_t>> moved;  // new number, old place
  for (std::size_t i = 0; i < count; ++i) {
    std::uint32_t index = 0;
    std::memcpy(&index, &at.values[i * index_bytes], index_bytes);
    moved.emplace_back(number[index], i);
  }
  std::sort(moved.begin(), moved.end());
  std::vector<std::uint32_t> indices;
  std::string ordered(values.values.size(), '\0');
  for (std::size_t i = 0; i < count; ++i) {
    indices.push_back(moved[i].first);
    std::memcpy(&ordered[i * bytes], &values.values[moved[i].second * bytes], bytes);
  }
  accessor["sparse"] = append_sparse_fields(work.draft, indices, ordered.data(), ordered.size());
  return accessor;
}

/// Puts an accessor's elements in order, under a new number.
int order_accessor(Ordering& work, int old, int uses, const std::vector<std::uint32_t>& number) {
  const Json accessor = work.draft.accessors[static_cast<std::size_t>(old)];
  const std::size_t bytes = component_bytes(accessor.at("componentType").get<int>()) *
                            components_of(accessor.at("type").get<std::string>());
  // A sparse accessor over other numbers than zeros is not what is written here.
  Json ordered = accessor.contains("sparse") && !accessor.contains("bufferView")
                     ? ordered_sparse(work, accessor, bytes, number)
                     : ordered_dense(work, accessor, bytes, number);
  const int placed = append_accessor(work.draft, std::move(ordered));
  release_accessor(work.draft, work.references, old, uses);
  return placed;
}

void order_indices(Ordering& work, Json& primitive, const std::vector<std::uint32_t>& indices) {
  const int old = primitive["indices"].get<int>();
  Json accessor = work.draft.accessors[static_cast<std::size_t>(old)];
  const std::size_t size = component_bytes(accessor.at("componentType").get<int>());
  std::string bytes(size * indices.size(), '\0');
  for (std::size_t i = 0; i < indices.size(); ++i) {
    std::memcpy(&bytes[i * size], &indices[i], size);  // little-endian as the file
  }
  accessor["bufferView"] = append_view(work.draft, bytes.data(), bytes.size(), BufferUse::Indices);
  for (const char* field : {"byteOffset", "min", "max"}) accessor.erase(field);
  primitive["indices"] = append_accessor(work.draft, std::move(accessor));
  release_accessor(work.draft, work.references, old, 1);
}

/// @return  the old number of each vertex
std::vector<int> order_primitive(Ordering& work, Json& primitive) {
  const auto position = primitive["attributes"].at("POSITION").get<std::size_t>();
  const auto vertices = work.draft.accessors[position].at("count").get<std::size_t>();
  std::vector<std::uint32_t> indices = indices_of(work, primitive["indices"].get<int>(), vertices);
  meshopt_optimizeVertexCache(indices.data(), indices.data(), indices.size(), vertices);
  const std::vector<std::uint32_t> number = new_numbers(indices, vertices);
  for (std::uint32_t& index : indices) index = number[index];
  order_indices(work, primitive, indices);
  std::map<int, int> placed;
  for (const auto& [accessor, uses] : uses_in(primitive)) {
    if (is_zero(work.draft.accessors[static_cast<std::size_t>(accessor)])) continue;
    placed[accessor] = order_accessor(work, accessor, uses, number);
  }
  for (Json* set : attribute_sets(primitive)) {
    for (auto& [name, accessor] : set->items()) {
      if (const auto found = placed.find(accessor.get<int>()); found != placed.end()) {
        accessor = found->second;
      }
    }
  }
  std::vector<int> old(vertices);
  for (std::size_t v = 0; v < vertices; ++v) old[number[v]] = static_cast<int>(v);
  return old;
}

}  // namespace

OrderedMorph order_vertices(const GltfFile& file, int node) {
  const GltfDocument& document = *file;
  Ordering work{document, join_buffers(document.json, document.buffers), {}};
  work.draft.shown = document.file;
  work.references = references_in(work.draft);
  const auto mesh = work.draft.json.at("nodes").at(static_cast<std::size_t>(node)).at("mesh");
  OrderedMorph ordered;
  for (Json& primitive : work.draft.json["meshes"].at(mesh.get<std::size_t>())["primitives"]) {
    const bool is_own = work.references.are_all && may_be_ordered(work, primitive);
    ordered.old_vertex.push_back(is_own ? order_primitive(work, primitive) : std::vector<int>());
  }
  remove_leftovers(work.draft);
  ordered.glb = glb_bytes(work.draft);
  return ordered;
}

}  // namespace morphbake
