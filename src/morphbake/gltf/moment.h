#pragma once

// Internal to gltf/: a file at a moment of one of its animations.

#include <Eigen/Core>
#include <vector>

#include "morphbake/gltf/document.h"
#include "morphbake/gltf/mesh_choice.h"

namespace morphbake {

/// Weights of a node's morph targets.
///
/// @param rest  the weights where the animation says nothing
/// @throws BakeError "gltf.no-such-animation", and as read_curve
Eigen::VectorXd weights_at(const GltfDocument& document, int node, const Moment& moment,
                           const Eigen::VectorXd& rest);

/// Each node's own transform.
///
/// @throws BakeError "gltf.no-such-animation", and as read_curve
std::vector<Eigen::Matrix4d> transforms_at(const GltfDocument& document, const Moment& moment);

}  // namespace morphbake
