#pragma once

// Internal to gltf/: the node that carries the mesh, and its place in the scene.

#include <Eigen/Core>

#include "morphbake/gltf/document.h"

namespace morphbake {

struct MeshNode {
  int node = 0;
  int mesh = 0;
  Eigen::Matrix4d to_scene = Eigen::Matrix4d::Identity();  ///< global transform
};

/// The nodes of the default scene (of all scenes without one) that have a mesh, in depth-first
/// order.
///
/// @throws BakeError "gltf.invalid" for cycles, several parents or indices out of range
std::vector<MeshNode> find_mesh_nodes(const GltfDocument& document);

}  // namespace morphbake
