#include "morphbake/gltf/primitive_geometry.h"

#include <fmt/core.h>

#include <algorithm>
#include <numeric>
#include <span>

#include "morphbake/gltf/accessors.h"

namespace morphbake {
namespace {

using Attributes = std::map<std::string, int>;

/// An attribute of three numbers a vertex, or no rows. What has another number of them is not read.
Float3s read_vectors(const GltfDocument& document, const Attributes& attributes,
                     const std::string& name, const std::string& pointer) {
  const auto found = attributes.find(name);
  if (found == attributes.end()) return {};
  return read_float3s(document, found->second, pointer + "/" + name);
}

/// Checks that all of them are of as many vertices, whether we look at them or not.
void check_counts(const GltfDocument& document, const Attributes& attributes, std::size_t vertices,
                  const std::string& pointer) {
  for (const auto& [name, accessor] : attributes) {
    check_count(document, accessor, vertices, fmt::format("{}/{}", pointer, name));
  }
}

std::size_t corner_count(const GltfDocument& document, const tinygltf::Primitive& primitive,
                         std::size_t vertices, const std::string& pointer) {
  if (primitive.indices < 0) return vertices;
  return index_count(document, primitive.indices, pointer + "/indices");
}

/// The vertices in the order in which triangles take them.
///
/// @param out  corner_count of them
void read_corners(const GltfDocument& document, const tinygltf::Primitive& primitive,
                  std::size_t vertices, const std::string& pointer, std::span<int> out) {
  if (primitive.indices < 0) {
    std::iota(out.begin(), out.end(), 0);
  } else {
    read_indices(document, primitive.indices, vertices, pointer + "/indices", out);
  }
}

/// Triangles of a strip (glTF 2.0, 3.7.2.1: {i, i + 1 + i % 2, i + 2 - i % 2}) or a fan
/// ({i + 1, i + 2, 0}).
TriangleIndices triangles_of_row(const std::vector<int>& order, bool is_fan) {
  std::vector<int> corners;
  for (std::size_t i = 0; i + 2 < order.size(); ++i) {
    const std::size_t odd = i % 2;
    const int a = is_fan ? order[i + 1] : order[i];
    const int b = is_fan ? order[i + 2] : order[i + 1 + odd];
    const int c = is_fan ? order[0] : order[i + 2 - odd];
    if (a == b || b == c || c == a) continue;
    corners.insert(corners.end(), {a, b, c});
  }
  return Eigen::Map<const TriangleIndices>(corners.data(),
                                           static_cast<Eigen::Index>(corners.size() / 3), 3);
}

TriangleIndices read_triangles(const GltfDocument& document, const tinygltf::Primitive& primitive,
                               std::size_t vertices, const std::string& pointer) {
  const int mode = primitive.mode < 0 ? TINYGLTF_MODE_TRIANGLES : primitive.mode;
  if (mode < TINYGLTF_MODE_TRIANGLES) {
    fail_at(document, pointer + "/mode", "gltf.unsupported-primitive",
            fmt::format("the primitive has mode {}: points or lines, which have no surface", mode),
            "export triangles (4), strips (5) or fans (6)");
  }
  const std::size_t corners = corner_count(document, primitive, vertices, pointer);
  if (mode != TINYGLTF_MODE_TRIANGLES) {
    std::vector<int> order(corners);
    read_corners(document, primitive, vertices, pointer, order);
    return triangles_of_row(order, mode == TINYGLTF_MODE_TRIANGLE_FAN);
  }
  if (corners % 3 != 0) {
    fail_at(document, pointer, "gltf.accessor",
            fmt::format("triangles need a multiple of 3 indices, not {}", corners));
  }
  TriangleIndices triangles(static_cast<Eigen::Index>(corners / 3), 3);
  read_corners(document, primitive, vertices, pointer, {triangles.data(), corners});
  return triangles;
}

}  // namespace

PrimitiveGeometry read_primitive_geometry(const GltfDocument& document,
                                          const tinygltf::Primitive& primitive,
                                          const std::string& pointer) {
  const std::string attributes = pointer + "/attributes";
  if (!primitive.attributes.contains("POSITION")) {
    fail_at(document, attributes, "gltf.unsupported-primitive", "the primitive has no POSITION");
  }
  PrimitiveGeometry geometry;
  geometry.positions =
      read_float3s(document, primitive.attributes.at("POSITION"), attributes + "/POSITION");
  const auto vertices = static_cast<std::size_t>(geometry.positions.rows());
  check_counts(document, primitive.attributes, vertices, attributes);
  geometry.normals = read_vectors(document, primitive.attributes, "NORMAL", attributes);
  geometry.triangles = read_triangles(document, primitive, vertices, pointer);
  return geometry;
}

TargetGeometry read_target(const GltfDocument& document, const tinygltf::Primitive& primitive,
                           std::size_t target, Eigen::Index vertices, const std::string& pointer) {
  const std::string place = fmt::format("{}/targets/{}", pointer, target);
  const Attributes& attributes = primitive.targets[target];
  check_counts(document, attributes, static_cast<std::size_t>(vertices), place);
  return {read_vectors(document, attributes, "POSITION", place),
          read_vectors(document, attributes, "NORMAL", place)};
}

std::size_t target_count(const GltfDocument& document, int mesh) {
  const auto& primitives = document.model.meshes[static_cast<std::size_t>(mesh)].primitives;
  for (std::size_t p = 1; p < primitives.size(); ++p) {
    if (primitives[p].targets.size() == primitives[0].targets.size()) continue;
    fail_at(document, primitive_pointer(mesh, p) + "/targets", "gltf.invalid",
            fmt::format("the primitive has {} morph targets, but the first one of the mesh has {}",
                        primitives[p].targets.size(), primitives[0].targets.size()));
  }
  return primitives.empty() ? 0 : primitives[0].targets.size();
}

std::vector<std::string> target_names(const tinygltf::Mesh& mesh, std::size_t count) {
  std::vector<std::string> names(count);
  if (!mesh.extras.IsObject() || !mesh.extras.Has("targetNames")) return names;
  const tinygltf::Value& list = mesh.extras.Get("targetNames");
  if (!list.IsArray()) return names;
  for (std::size_t t = 0; t < std::min(count, list.ArrayLen()); ++t) {
    const tinygltf::Value& name = list.Get(static_cast<int>(t));
    if (name.IsString()) names[t] = name.Get<std::string>();
  }
  return names;
}

Eigen::VectorXd rest_weights(const tinygltf::Node& node, const tinygltf::Mesh& mesh,
                             std::size_t count) {
  const std::vector<double>& weights = node.weights.empty() ? mesh.weights : node.weights;
  Eigen::VectorXd rest = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(count));
  for (std::size_t t = 0; t < std::min(count, weights.size()); ++t) {
    rest(static_cast<Eigen::Index>(t)) = weights[t];
  }
  return rest;
}

}  // namespace morphbake
