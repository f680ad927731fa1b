#include "morphbake/gltf/quantise_mesh.h"

#include <fmt/core.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
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
struct Quantising {
  const GltfDocument& document;
  GlbDraft draft;
  References references;
  std::size_t mesh = 0;
};

Json& primitives_of(Quantising& work) {
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

Float3s rows_of(const Quantising& work, int accessor) {
  return read_float3s(work.document, accessor, child_pointer("/meshes", work.mesh));
}

Cube cube_about(Quantising& work) {
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

/// Puts integers in the place of an attribute's floats; `fractions` makes them of rows, or nothing
/// where they stay.
template <typename Fractions>
void quantise_attribute(Quantising& work, const char* attribute, int bytes,
                        const Fractions& fractions) {
  std::map<std::pair<int, bool>, int> made;
  for_each_accessor(primitives_of(work), attribute, [&](Json& accessor, bool is_moved) {
    const int old = accessor.get<int>();
    const auto [entry, is_new] = made.try_emplace({old, is_moved}, -1);
    if (is_new) {
      const Float3s rows = rows_of(work, old);
      const std::vector<std::uint32_t> moving = moving_rows(rows);
      const bool is_zero = is_moved && moving.empty();  // and stays what it is
      const std::optional<Float3s> fractioned = is_zero ? std::nullopt : fractions(rows, is_moved);
      if (fractioned) {
        const Integers integers = integers_of(*fractioned, bytes);
        const bool is_sparse =
            work.draft.accessors[static_cast<std::size_t>(old)].contains("sparse");
        entry->second = is_moved && is_sparse ? append_sparse(work.draft, integers, bytes, moving)
                                              : append_dense(work.draft, integers, bytes);
      }
    }
    if (entry->second < 0) return;
    release_accessor(work.draft, work.references, old, 1);
    accessor = entry->second;
  });
}

/// Where nothing but the node's own transform places the mesh, a node below it may scale it.
void require_free(const Quantising& work, std::size_t node) {
  const Json& json = work.draft.json["nodes"][node];
  const bool is_instanced =
      json.contains("extensions") && json["extensions"].contains("EXT_mesh_gpu_instancing");
  if (!json.contains("skin") && !is_instanced) return;
  fail_at(work.document, fmt::format("/nodes/{}/{}", node, is_instanced ? "extensions" : "skin"),
          "export.cannot-quantise",
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
std::size_t lower_mesh(Quantising& work, std::size_t node, const Cube& cube) {
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

EncodedMorph quantise_mesh(const GltfFile& file, int node, const QuantisedSteps& steps) {
  const GltfDocument& document = *file;
  Quantising work{document, join_buffers(document.json, document.buffers), {}, 0};
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
  quantise_attribute(work, "POSITION", 2,
                     [&](const Float3s& rows, bool is_moved) -> std::optional<Float3s> {
                       if (is_moved) return Float3s(rows / cube.half);
                       return Float3s((rows.rowwise() - cube.centre) / cube.half);
                     });
  quantise_attribute(work, "NORMAL", steps.normal_bits / 8,
                     [](const Float3s& rows, bool) -> std::optional<Float3s> {
                       constexpr float kRounding = 1e-6F;  // of unit normals
                       if (!(rows.cwiseAbs().maxCoeff() <= 1 + kRounding)) return {};
                       return rows;
                     });
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
