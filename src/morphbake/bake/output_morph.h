#pragma once

#include <memory>
#include <string>
#include <vector>

#include "morphbake/bake/options.h"
#include "morphbake/bake/solved_recipe.h"
#include "morphbake/export/mesh_morph.h"

namespace morphbake {

/// A morph and the motion that each of its clips is to show; of a still, that it does not move.
struct MorphWithMotions {
  MeshMorph morph;
  std::unique_ptr<ReferenceMotion> timeline;  ///< of which the motions are parts
  std::vector<ReferenceMotion> motions;
  std::string kind;  ///< of targets, as recipes write it, or "still"
};

/// What an output is made from, beside the recipe.
struct OutputInputs {
  const Output& output;
  TargetKind kind;
  const BakeOptions& options;
  const Observer& observer;
};

/// The kind that is asked for; `auto` is tracks where there are some, else Auto: the fewest
/// targets.
TargetKind kind_of(const Output& output, const SolvedTimeline& timeline);

/// Keyframes, or a basis where that has fewer targets: a morph is as large as it has targets. Of
/// keyframes two are active at any time, of a basis all.
///
/// @param tolerance  of positions, scene units
MorphBasis smallest_basis(const FrameSource& frames, double tolerance,
                          const std::vector<Clip>& clips, const Observer& observer);

MorphWithMotions make_still_output(const SolvedRecipe& solved, const Still& still,
                                   const SolveOptions& options);

/// @param tolerance  of positions, scene units; tracks and frames need none
MorphWithMotions make_animated_output(const SolvedRecipe& solved, const OutputInputs& inputs,
                                      double tolerance);

}  // namespace morphbake
