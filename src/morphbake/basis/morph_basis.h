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
  Positions base;                        ///< #V by 3, scene space
  TargetKind kind = TargetKind::Tracks;  ///< the base of a Basis is no frame, of others the first
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

/// The same of as few frames as keep every vertex of every frame within `tolerance`; frames that
/// are the same share a target, those that are the first need none.
///
/// @param tolerance  scene units
MorphBasis keyframe_basis(const FrameSource& frames, double tolerance,
                          const std::vector<Clip>& clips, const Observer& observer);

/// As few targets as keep every vertex of every frame within `tolerance`, all of them active: the
/// truncated singular value decomposition, folded so that weights stay in [0, 1].
///
/// @param tolerance  scene units
MorphBasis principal_basis(const FrameSource& frames, double tolerance,
                           const std::vector<Clip>& clips, const Observer& observer);

}  // namespace morphbake
