#pragma once

#include <string>
#include <vector>

#include "morphbake/basis/basis_options.h"
#include "morphbake/mesh/mesh.h"
#include "morphbake/recipe/recipe.h"
#include "morphbake/solve/frame_source.h"

namespace morphbake {

struct MorphTarget {
  std::string name;
  Positions displacement;  ///< #V by 3, scene space
};

/// Weights that are linear between keys.
struct WeightKeys {
  std::vector<float> times;  ///< seconds, rising strictly, the first is 0
  Eigen::MatrixXf weights;   ///< #keys by #targets, each in [0, 1]
};

/// A motion as glTF plays it: base + sum_k w_k(t) displacement_k.
struct MorphBasis {
  Positions base;  ///< #V by 3, scene space, the first frame
  std::vector<MorphTarget> targets;
  std::vector<WeightKeys> clips;  ///< one a clip
};

/// One target a solved shape ("nose", "body", and their product where they overlap), whose weights
/// are the eased amounts, keyed as densely as the tolerance asks for.
MorphBasis track_basis(const SolvedShapes& shapes, const SeparableTimeline& separable,
                       const Timeline& timeline, const std::vector<Clip>& clips,
                       const BasisOptions& options);

/// One target a frame, each fading into the next.
MorphBasis frame_basis(const FrameSource& frames, const std::vector<Clip>& clips);

}  // namespace morphbake
