#pragma once

#include <vector>

#include "morphbake/basis/frame_blocks.h"

namespace morphbake {

/// Frames as combinations of few shapes: displacement of frame t = sum_k weights(t, k) shape_k.
struct PrincipalShapes {
  std::vector<Positions> shapes;  ///< #V by 3 each, the first tells most
  Eigen::MatrixXd weights;        ///< #frames by #shapes, orthonormal columns
};

/// The truncated singular value decomposition of the displacements from the first frame, with as
/// many shapes as keep every vertex of every frame within the tolerance.
///
/// The Gram matrix of the frames is formed in float64: its square root is what is left of digits.
/// @param tolerance  scene units
/// @cost             O(#frames^2 #V + #frames^3); reads all frames three to six times
PrincipalShapes principal_shapes(const FrameSource& frames, double tolerance,
                                 const Observer& observer);

}  // namespace morphbake
