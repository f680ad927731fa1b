#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <vector>

#include "morphbake/gltf/animated_mesh.h"

namespace morphbake {

/// A primitive's vertices at one moment, in the space of the transform that it was posed with.
struct PosedPrimitive {
  /// (#V + 1) by 3: Embree reads 16 bytes at the last vertex, so one row of padding follows it.
  Float3s positions;
  Float3s normals;  ///< #V by 3 of unit length (zero where the file's are), or no rows
  Float3s colours;  ///< #V by 3 linear RGB, or no rows: white
};

/// Morphs `primitive` (base + sum of weight times target, glTF 2.0, 3.7.2.2) and transforms it.
///
/// @param weights  one a target; targets beyond its size rest
/// @param pose     receives the result; its memory is kept from call to call
void pose_primitive(const AnimatedPrimitive& primitive, const Eigen::VectorXd& weights,
                    const Eigen::Affine3d& transform, PosedPrimitive& pose);

/// All primitives of `mesh`, as pose_primitive.
void pose_mesh(const AnimatedMesh& mesh, const Eigen::VectorXd& weights,
               const Eigen::Affine3d& transform, std::vector<PosedPrimitive>& poses);

}  // namespace morphbake
