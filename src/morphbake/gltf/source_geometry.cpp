#include "morphbake/gltf/source_geometry.h"

#include <fmt/core.h>

#include <Eigen/LU>
#include <cmath>

#include "morphbake/gltf/accessors.h"
#include "morphbake/gltf/nodes.h"

namespace morphbake {
namespace {

MeshNode only_mesh_node(const GltfDocument& document) {
  const std::vector<MeshNode> nodes = find_mesh_nodes(document);
  if (nodes.empty()) {
    fail_at(document, "/nodes", "gltf.no-mesh", "no node of the scene has a mesh",
            "export the mesh that is to be morphed");
  }
  if (nodes.size() > 1) {
    fail_at(document, fmt::format("/nodes/{}", nodes[1].node), "gltf.several-meshes",
            fmt::format("the scene has {} nodes with a mesh; only one is supported", nodes.size()),
            "export the mesh that is to be morphed alone, or join the meshes");
  }
  return nodes.front();
}

void check_node(const GltfDocument& document, const MeshNode& at) {
  const tinygltf::Node& node = document.model.nodes[static_cast<std::size_t>(at.node)];
  if (node.skin >= 0) {
    fail_at(document, fmt::format("/nodes/{}/skin", at.node), "gltf.unsupported-skin",
            "skinned meshes are not supported", "export the mesh without its armature");
  }
  const double determinant = at.to_scene.topLeftCorner<3, 3>().determinant();
  if (!(std::abs(determinant) > 1e-30)) {
    fail_at(document, fmt::format("/nodes/{}", at.node), "gltf.singular-transform",
            "the node's transform flattens the mesh (determinant 0)",
            "apply the transform and export again");
  }
}

PrimitiveGeometry read_primitive(const GltfDocument& document, const tinygltf::Primitive& primitive,
                                 const std::string& pointer) {
  if (primitive.mode != -1 && primitive.mode != TINYGLTF_MODE_TRIANGLES) {
    fail_at(
        document, pointer + "/mode", "gltf.unsupported-primitive",
        fmt::format("primitive mode {} is not supported; only triangles (4) are", primitive.mode),
        "export triangles");
  }
  if (primitive.indices < 0) {
    fail_at(document, pointer, "gltf.unsupported-primitive",
            "primitives without indices are not supported", "export indexed triangles");
  }
  if (!primitive.targets.empty()) {
    fail_at(document, pointer + "/targets", "gltf.unsupported-targets",
            "sources that already have morph targets are not supported",
            "export without shape keys, or apply them first");
  }
  const auto position = primitive.attributes.find("POSITION");
  if (position == primitive.attributes.end()) {
    fail_at(document, pointer + "/attributes", "gltf.unsupported-primitive",
            "the primitive has no POSITION");
  }
  PrimitiveGeometry geometry;
  geometry.positions = read_float3s(document, position->second, pointer + "/attributes/POSITION");
  if (const auto normal = primitive.attributes.find("NORMAL");
      normal != primitive.attributes.end()) {
    geometry.normals = read_float3s(document, normal->second, pointer + "/attributes/NORMAL");
    if (geometry.normals.rows() != geometry.positions.rows()) {
      fail_at(document, pointer + "/attributes/NORMAL", "gltf.accessor",
              fmt::format("there are {} normals for {} positions", geometry.normals.rows(),
                          geometry.positions.rows()));
    }
  }
  geometry.triangles =
      read_triangles(document, primitive.indices,
                     static_cast<std::size_t>(geometry.positions.rows()), pointer + "/indices");
  return geometry;
}

/// Morph targets need the same attributes in every primitive, else viewers mix them up.
void check_normals(const GltfDocument& document, const SourceGeometry& source) {
  const bool first_has = source.primitives.front().normals.rows() > 0;
  for (std::size_t p = 1; p < source.primitives.size(); ++p) {
    if ((source.primitives[p].normals.rows() > 0) == first_has) continue;
    fail_at(document, primitive_pointer(source.mesh, p) + "/attributes", "gltf.mixed-normals",
            "some primitives of the mesh have NORMAL and others have not",
            "export the whole mesh with normals, or all of it without");
  }
}

}  // namespace

std::string primitive_pointer(int mesh, std::size_t primitive) {
  return fmt::format("/meshes/{}/primitives/{}", mesh, primitive);
}

SourceGeometry read_source_geometry(const GltfFile& file) {
  const GltfDocument& document = *file;
  const MeshNode at = only_mesh_node(document);
  check_node(document, at);
  if (static_cast<std::size_t>(at.mesh) >= document.model.meshes.size()) {
    fail_at(document, fmt::format("/nodes/{}/mesh", at.node), "gltf.invalid",
            fmt::format("mesh {} does not exist", at.mesh));
  }
  SourceGeometry source{at.node, at.mesh, at.to_scene, {}};
  const tinygltf::Mesh& mesh = document.model.meshes[static_cast<std::size_t>(at.mesh)];
  for (std::size_t p = 0; p < mesh.primitives.size(); ++p) {
    source.primitives.push_back(
        read_primitive(document, mesh.primitives[p], primitive_pointer(at.mesh, p)));
  }
  if (source.primitives.empty()) {
    fail_at(document, fmt::format("/meshes/{}", at.mesh), "gltf.no-mesh",
            "the mesh has no primitive");
  }
  check_normals(document, source);
  return source;
}

}  // namespace morphbake
