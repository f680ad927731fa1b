#pragma once

// Internal to gltf/: the geometry of primitives, in every form that glTF has for it.

#include <string>
#include <vector>

#include "morphbake/gltf/animated_mesh.h"
#include "morphbake/gltf/document.h"
#include "morphbake/gltf/source_geometry.h"

namespace morphbake {

/// A primitive's triangles and base shape.
///
/// Strips, fans and lists without indices become triangles; those of a strip that repeat a vertex
/// are left out, since strips turn corners with them.
/// @param pointer  of the primitive
/// @throws BakeError "gltf.unsupported-primitive", "gltf.accessor", "gltf.not-finite"
PrimitiveGeometry read_primitive_geometry(const GltfDocument& document,
                                          const tinygltf::Primitive& primitive,
                                          const std::string& pointer);

/// What a morph target adds.
struct TargetGeometry {
  Float3s positions;  ///< #V by 3 displacement, or no rows
  Float3s normals;    ///< likewise
};

/// @param vertices  of the primitive
/// @throws BakeError "gltf.accessor", "gltf.not-finite"
TargetGeometry read_target(const GltfDocument& document, const tinygltf::Primitive& primitive,
                           std::size_t target, Eigen::Index vertices, const std::string& pointer);

/// Number of morph targets, which is one for all primitives.
///
/// @throws BakeError "gltf.invalid" when it is not
std::size_t target_count(const GltfDocument& document, int mesh);

/// extras.targetNames; "" where there is none.
std::vector<std::string> target_names(const tinygltf::Mesh& mesh, std::size_t count);

/// Weights of the targets at rest: the node's, else the mesh's, else 0.
Eigen::VectorXd rest_weights(const tinygltf::Node& node, const tinygltf::Mesh& mesh,
                             std::size_t count);

}  // namespace morphbake
