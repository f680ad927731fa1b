#include "morphbake/gltf/quantize_mesh.h"

#include <fmt/core.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <functional>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "morphbake/gltf/accessors.h"
#include "morphbake/gltf/displacements.h"
#include "morphbake/gltf/draft_references.h"
#include "morphbake/gltf/primitive_geometry.h"

namespace morphbake {
namespace {

constexpr int kByte = 5120, kShort = 5122;
constexpr const char* kQuantization = "KHR_mesh_quantization";

/// From mesh space to fractions of a cube.
struct Cube {
  Eigen::RowVector3f centre = Eigen::RowVector3f::Zero();
  float half = 1;
};

/// A mesh on its way to integers.
struct Quantizing {
  const GltfDocument& document;
  GlbDraft draft;
  References references;
  std::size_t mesh = 0;
};

Json& primitives_of(Quantizing& work) {
  return work.draft.json.at("meshes").at(work.mesh).at("primitives");
}

/// Calls `visit(accessor, is a displacement)` for every one of the attribute in the mesh.
template <typename Visit>
void for_each_accessor(Json& primitives, const char* attribute, const Visit& visit) {
  for (std::size_t p = 0; p < primitives.size(); ++p) {
    Json& primitive = primitives[p];
    if (primitive["attributes"].contains(attribute)) {
      visit(primitive["attributes"][attribute], false);
    }
    if (!primitive.contains("targets")) continue;
    for (Json& target : primitive["targets"]) {
      if (target.contains(attribute)) visit(target[attribute], true);
    }
  }
}

Float3s rows_of(const Quantizing& work, int accessor) {
  return read_float3s(work.document, accessor, child_pointer("/meshes", work.mesh));
}

Cube cube_about(Quantizing& work) {
  Eigen::AlignedBox3f box;
  float farthest = 0;
  for_each_accessor(primitives_of(work), "POSITION", [&](const Json& accessor, bool is_moved) {
    const Float3s rows = rows_of(work, accessor.get<int>());
    if (rows.rows() == 0) return;
    if (is_moved) {
      farthest = std::max(farthest, rows.cwiseAbs().maxCoeff());
    } else {
      box.extend(rows.colwise().minCoeff().transpose());
      box.extend(rows.colwise().maxCoeff().transpose());
    }
  });
  if (box.isEmpty()) return {};
  Cube cube{box.center().transpose(), std::max(farthest, box.sizes().maxCoeff() / 2)};
  if (!(cube.half > 0)) cube.half = 1;  // a point
  return cube;
}

using Integers = Eigen::Matrix<int, Eigen::Dynamic, 3, Eigen::RowMajor>;

/// The largest number of an integer of some bytes.
int largest_of(int bytes) { return bytes == 1 ? 127 : 32767; }

/// @param fractions  within [-1, 1]
Integers integers_of(const Float3s& fractions, int bytes) {
  const int most = largest_of(bytes);
  return (fractions * static_cast<float>(most)).unaryExpr([most](float x) {
    return std::clamp(static_cast<int>(std::round(x)), -most, most);
  });
}

/// Bytes of the rows, each followed by room up to `stride`.
std::string packed_rows(const Integers& rows, int bytes, std::size_t stride) {
  std::string packed(stride * static_cast<std::size_t>(rows.rows()), '\0');
  for (Eigen::Index i = 0; i < rows.rows(); ++i) {
    for (int axis = 0; axis < 3; ++axis) {
      const auto number =
          static_cast<std::int16_t>(rows(i, axis));  // its first byte is an 8-bit one
      std::memcpy(
          &packed[stride * static_cast<std::size_t>(i) + static_cast<std::size_t>(bytes * axis)],
          &number, static_cast<std::size_t>(bytes));
    }
  }
  return packed;
}

/// An accessor of integers, without its bytes.
Json integer_accessor(const Integers& rows, int bytes) {
  Json least = Json::array(), most = Json::array();
  for (int axis = 0; axis < 3; ++axis) {
    least.push_back(rows.rows() > 0 ? rows.col(axis).minCoeff() : 0);
    most.push_back(rows.rows() > 0 ? rows.col(axis).maxCoeff() : 0);
  }
  return {{"componentType", bytes == 1 ? kByte : kShort},
          {"normalized", true},
          {"count", rows.rows()},
          {"type", "VEC3"},
          {"min", least},
          {"max", most}};
}

int append_dense(GlbDraft& draft, const Integers& rows, int bytes) {
  const std::size_t stride = bytes == 1 ? 4 : 8;
  const std::string packed = packed_rows(rows, bytes, stride);
  Json view = append_bytes(draft, packed.data(), packed.size(), BufferUse::Vertices);
  view["byteStride"] = stride;
  Json accessor = integer_accessor(rows, bytes);
  accessor["bufferView"] = add_view(draft, std::move(view));
  return append_accessor(draft, std::move(accessor));
}

int append_sparse(GlbDraft& draft, const Integers& rows, int bytes,
                  const std::vector<std::uint32_t>& moving) {
  const Integers moved = rows(moving, Eigen::all);
  const std::string packed = packed_rows(moved, bytes, 3 * static_cast<std::size_t>(bytes));
  Json accessor = integer_accessor(rows, bytes);
  accessor["sparse"] = append_sparse_fields(draft, moving, packed.data(), packed.size());
  return append_accessor(draft, std::move(accessor));
}

/// An attribute on its way to integers.
struct QuantizedAttribute {
  const char* name = nullptr;
  int bytes = 2;
  /// Rows as fractions within [-1, 1], or nothing where they stay floats.
  std::function<std::optional<Float3s>(const Float3s& rows, bool is_moved)> fractions;
  std::map<std::pair<int, bool>, int> made;  ///< of an accessor, and of displacements: the new one
};

/// Puts integers in the place of an accessor's floats.
///
/// @param fractions  of its rows
/// @return           what is left of them when they are rounded
Float3s quantize_accessor(Quantizing& work, QuantizedAttribute& attribute, Json& accessor,
                          const Float3s& fractions, const std::vector<std::uint32_t>& moving,
                          bool is_moved) {
  const int old = accessor.get<int>();
  const Integers integers = integers_of(fractions, attribute.bytes);
  const auto [entry, is_new] = attribute.made.try_emplace({old, is_moved}, -1);
  if (is_new) {
    const bool is_sparse =
        is_moved && work.draft.accessors[static_cast<std::size_t>(old)].contains("sparse");
    entry->second = is_sparse ? append_sparse(work.draft, integers, attribute.bytes, moving)
                              : append_dense(work.draft, integers, attribute.bytes);
  }
  release_accessor(work.draft, work.references, old, 1);
  accessor = entry->second;
  return fractions - integers.cast<float>() / static_cast<float>(largest_of(attribute.bytes));
}

/// The targets' first, so that the base can take what they lose on average.
void quantize_primitive(Quantizing& work, QuantizedAttribute& attribute, Json& primitive,
                        const std::vector<float>& mean_weights) {
  Json& attributes = primitive["attributes"];
  if (!attributes.contains(attribute.name)) return;
  Json& base = attributes[attribute.name];
  const Float3s rest = rows_of(work, base.get<int>());
  Float3s lost = Float3s::Zero(rest.rows(), 3);
  const std::size_t targets = primitive.contains("targets") ? primitive["targets"].size() : 0;
  for (std::size_t t = 0; t < targets; ++t) {
    Json& target = primitive["targets"][t];
    if (!target.contains(attribute.name)) continue;
    const Float3s rows = rows_of(work, target[attribute.name].get<int>());
    const std::vector<std::uint32_t> moving = moving_rows(rows);
    if (moving.empty()) continue;  // zeros stay what they are
    const std::optional<Float3s> fractions = attribute.fractions(rows, true);
    if (!fractions) continue;
    const Float3s left =
        quantize_accessor(work, attribute, target[attribute.name], *fractions, moving, true);
    const std::size_t from_end = targets - t;
    if (from_end <= mean_weights.size()) {
      lost += mean_weights[mean_weights.size() - from_end] * left;
    }
  }
  std::optional<Float3s> fractions = attribute.fractions(rest, false);
  if (!fractions) return;
  const bool is_own = work.references.accessors.at(base.get<std::size_t>()) == 1;
  if (is_own) *fractions += lost;  // what others show too stays as it is
  quantize_accessor(work, attribute, base, *fractions, {}, false);
}

/// Where nothing but the node's own transform places the mesh, a node below it may scale it.
void require_free(const Quantizing& work, std::size_t node) {
  const Json& json = work.draft.json["nodes"][node];
  const bool is_instanced =
      json.contains("extensions") && json["extensions"].contains("EXT_mesh_gpu_instancing");
  if (!json.contains("skin") && !is_instanced) return;
  fail_at(work.document, fmt::format("/nodes/{}/{}", node, is_instanced ? "extensions" : "skin"),
          "export.cannot-quantize",
          fmt::format("{} place the mesh, which no node can scale for itself",
                      is_instanced ? "instances" : "joints"),
          "write \"encoding\": \"float\" for this output");
}

/// Lets what moves the weights of a node move those of another.
void redirect_weights(Json& json, std::size_t from, std::size_t to) {
  if (!json.contains("animations")) return;
  const std::string pointer = fmt::format("/nodes/{}/weights", from);
  for (Json& animation : json["animations"]) {
    for (Json& channel : animation.at("channels")) {
      Json& target = channel.at("target");
      if (target.value("path", "") == "weights" &&
          target.value("node", -1) == static_cast<int>(from)) {
        target["node"] = to;
      }
      if (!target.contains("extensions")) continue;
      Json& extensions = target["extensions"];
      if (!extensions.contains("KHR_animation_pointer")) continue;
      Json& pointed = extensions["KHR_animation_pointer"]["pointer"];
      const std::string path = pointed.get<std::string>();
      if (path != pointer && !path.starts_with(pointer + "/")) continue;
      pointed = fmt::format("/nodes/{}/weights{}", to, path.substr(pointer.size()));
    }
  }
}

/// Hangs the mesh of a node on a new one below it. @return the new one
std::size_t lower_mesh(Quantizing& work, std::size_t node, const Cube& cube) {
  Json& nodes = work.draft.json["nodes"];
  const std::size_t lowered = nodes.size();
  Json below = {{"mesh", work.mesh}};
  if (nodes[node].contains("weights")) below["weights"] = nodes[node]["weights"];
  nodes[node].erase("weights");
  nodes[node].erase("mesh");
  const float half = cube.half;
  below["scale"] = {half, half, half};
  below["translation"] = {cube.centre(0), cube.centre(1), cube.centre(2)};
  nodes[node]["children"].push_back(lowered);
  nodes.push_back(std::move(below));
  redirect_weights(work.draft.json, node, lowered);
  return lowered;
}

}  // namespace

EncodedMorph quantize_mesh(const GltfFile& file, int node, const QuantizedSteps& steps) {
  const GltfDocument& document = *file;
  Quantizing work{document, join_buffers(document.json, document.buffers), {}, 0};
  work.draft.shown = document.file;
  work.references = references_in(work.draft);
  const auto shown = static_cast<std::size_t>(node);
  work.mesh = work.draft.json.at("nodes").at(shown).at("mesh").get<std::size_t>();
  std::vector<std::size_t> users;
  for (std::size_t n = 0; n < work.draft.json["nodes"].size(); ++n) {
    if (work.draft.json["nodes"][n].value("mesh", -1) != static_cast<int>(work.mesh)) continue;
    require_free(work, n);
    users.push_back(n);
  }
  Cube cube = cube_about(work);
  cube.half = std::max(cube.half, static_cast<float>(steps.position * largest_of(2)));
  QuantizedAttribute positions{"POSITION",
                               2,
                               [&](const Float3s& rows, bool is_moved) -> std::optional<Float3s> {
                                 if (is_moved) return Float3s(rows / cube.half);
                                 return Float3s((rows.rowwise() - cube.centre) / cube.half);
                               },
                               {}};
  QuantizedAttribute normals{"NORMAL",
                             steps.normal_bits / 8,
                             [](const Float3s& rows, bool) -> std::optional<Float3s> {
                               constexpr float kRounding = 1e-6F;  // of unit normals
                               if (!(rows.cwiseAbs().maxCoeff() <= 1 + kRounding)) return {};
                               return rows;
                             },
                             {}};
  for (Json& primitive : primitives_of(work)) {
    quantize_primitive(work, positions, primitive, steps.mean_weights);
    quantize_primitive(work, normals, primitive, steps.mean_weights);
  }
  EncodedMorph encoded;
  for (const std::size_t n : users) {
    const std::size_t lowered = lower_mesh(work, n, cube);
    if (n == shown) encoded.node = static_cast<int>(lowered);
  }
  require_extension(work.draft.json, kQuantization);
  remove_leftovers(work.draft);
  encoded.glb = glb_bytes(work.draft);
  return encoded;
}

}  // namespace morphbake
