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
/// @param rest     at the base, within [0, 1]: stands as it is, but where the base is no frame it
/// is
///                 fitted as well, since no moment shows it, and stays within [0, 1] as glTF wants
///                 it
/// @param motions  one a clip of the basis
FittedVectors fit_colours(const MorphBasis& basis, const Positions& rest,
                          const std::vector<VectorMotion>& motions);

/// What numbers of targets may be.
enum class TargetRange {
  Any,
  Unit,  ///< within [-1, 1], as integers that stand for fractions, where that changes few of them
};

/// The same of unit vectors, of whose morphs only the directions count: shaders norm them. So each
/// may have its own scale with its targets, and its rest is a unit vector, as glTF wants it.
FittedVectors fit_directions(const MorphBasis& basis, const Normals& rest,
                             const std::vector<VectorMotion>& motions, TargetRange range);

}  // namespace morphbake
