#pragma once

#include <functional>
#include <vector>

#include "morphbake/basis/morph_basis.h"
#include "morphbake/mesh/mesh.h"

namespace morphbake {

/// Vectors as glTF morphs them: rest + sum_k w_k target_k.
struct FittedVectors {
  Positions rest;                  ///< #R by 3
  std::vector<Positions> targets;  ///< one a target of the basis: #R by 3
};

/// What a clip of the basis is to show: vectors at some moments.
struct VectorMotion {
  std::vector<double> times;                         ///< seconds, from the clip's begin on
  std::function<Positions(double time)> vectors_at;  ///< #R by 3
};

/// The least-squares fit of what changes with the shape, but not linearly, to the basis' weights
/// over all clips.
///
/// @param rest     at the base: stands as it is, but where the base is no frame it is fitted as
///                 well, since no moment shows it
/// @param motions  one a clip of the basis
FittedVectors fit_targets(const MorphBasis& basis, const Positions& rest,
                          const std::vector<VectorMotion>& motions);

}  // namespace morphbake
