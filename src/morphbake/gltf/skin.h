#pragma once

// Internal to gltf/: skeletons (glTF 2.0, 3.7.3).

#include <Eigen/Core>
#include <string>
#include <vector>

#include "morphbake/gltf/animated_mesh.h"
#include "morphbake/gltf/document.h"

namespace morphbake {

/// What each joint does to a vertex: from mesh space to the scene.
///
/// @param to_scene  one a node: global transform
/// @return          one a joint, at least one
/// @throws BakeError "gltf.invalid", "gltf.accessor", "gltf.not-finite"
std::vector<Eigen::Matrix4d> joint_transforms(const GltfDocument& document, int skin,
                                              const std::vector<Eigen::Matrix4d>& to_scene);

/// Where a skinned mesh is as it was bound: what its joints do to it there. Joints may be flat, as
/// a hidden limb's is; then the first that is not tells, and the identity when all are.
///
/// @param joints  of joint_transforms
/// @return        from mesh space to the scene; is_invertible
Eigen::Matrix4d bound_to_scene(const std::vector<Eigen::Matrix4d>& joints);

/// How a primitive's vertices hang on the joints: JOINTS_n and WEIGHTS_n.
struct SkinBinding {
  std::vector<std::uint32_t> joints;  ///< #V by `width`
  std::vector<float> weights;         ///< likewise; each row sums to 1, or is 0
  std::size_t width = 0;              ///< joints a vertex
};

/// @param joint_count  of the skin
/// @param pointer      of the primitive
/// @throws BakeError "gltf.invalid", "gltf.accessor", "gltf.not-finite"
SkinBinding read_binding(const GltfDocument& document, const tinygltf::Primitive& primitive,
                         std::size_t joint_count, const std::string& pointer);

/// Moves points and normals by the joints: linear blend skinning.
///
/// @param transforms  one a joint
void pose(const SkinBinding& binding, const std::vector<Eigen::Matrix4d>& transforms,
          Float3s& positions, Float3s& normals);

}  // namespace morphbake
