#pragma once

#include <Eigen/Core>
#include <vector>

#include "morphbake/gltf/animated_mesh.h"
#include "morphbake/mesh/mesh.h"

namespace morphbake {

/// Base plus weighted targets of one attribute, in double from the file's floats (glTF 2.0,
/// 3.7.2.2). Pictures do with float: see pose_primitive.
///
/// @param base     #V by 3
/// @param targets  #V by 3 each, or no rows for a target that does not move the attribute
/// @param weights  one a target; targets beyond its size rest
Positions morphed_rows(const Float3s& base, const std::vector<Float3s>& targets,
                       const Eigen::VectorXd& weights);

/// All vertices of a mesh at `weights`, primitive after primitive: #R by 3, scene space.
Positions morphed_positions(const AnimatedMesh& mesh, const Eigen::VectorXd& weights);

}  // namespace morphbake
