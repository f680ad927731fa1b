#pragma once

// Internal to gltf/: the node that carries the mesh, and its place in the scene.

#include <Eigen/Core>
#include <vector>

#include "morphbake/gltf/document.h"
#include "morphbake/gltf/mesh_choice.h"

namespace morphbake {

struct MeshNode {
  int node = 0;
  int mesh = 0;
  Eigen::Matrix4d to_scene = Eigen::Matrix4d::Identity();  ///< from mesh space, skinned or not
};

/// The nodes of the default scene (the first one when the file names none) in depth-first order,
/// then those that it does not show.
struct NodeOrder {
  std::vector<int> nodes;
  std::size_t shown = 0;                  ///< how many of them are in the default scene
  std::vector<Eigen::Matrix4d> to_scene;  ///< one a node of the file: global transform
};

/// @param locals  one a node: its own transform
/// @throws BakeError "gltf.invalid" for cycles, several parents or indices out of range,
///         "gltf.not-finite"
NodeOrder order_nodes(const GltfDocument& document, const std::vector<Eigen::Matrix4d>& locals);

/// Each node's own transform, as the file has it.
std::vector<Eigen::Matrix4d> rest_transforms(const GltfDocument& document);

/// Translation, rotation and scale as one matrix; what is empty is the identity.
Eigen::Matrix4d transform_of(const std::vector<double>& translation,
                             const std::vector<double>& rotation, const std::vector<double>& scale);

/// Whether a transform flattens nothing.
bool is_invertible(const Eigen::Matrix4d& transform);

/// What is to be done when several nodes could be meant.
enum class Ambiguity { Refuse, TakeFirst };

/// The node and mesh that are meant.
///
/// A skinned mesh is where its skin binds it: glTF ignores the transform of its node.
/// @throws BakeError as order_nodes; "gltf.no-mesh", "gltf.several-meshes", "gltf.no-such-node",
///         "gltf.no-such-mesh", "gltf.invalid", "gltf.singular-transform"
MeshNode choose_mesh_node(const GltfDocument& document, const MeshChoice& choice,
                          Ambiguity ambiguity);

}  // namespace morphbake
