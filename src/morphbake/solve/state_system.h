#pragma once

#include <memory>
#include <span>
#include <vector>

#include "morphbake/diagnostics/observer.h"
#include "morphbake/solve/displacement_system.h"
#include "morphbake/solve/rotation_blend.h"
#include "morphbake/transition/timeline.h"

namespace morphbake {

/// A displacement system, and how transition states become its goals.
struct StateSystem {
  const MorphableMesh& mesh;
  Shares reference;  ///< the same at every vertex; what is held has them at all times
  Positions rest;    ///< #V by 3: the reference's shape, from which displacements start
  std::unique_ptr<DisplacementSystem> displacements;
  std::unique_ptr<RotationBlend> rotations;  ///< none: differences are blended as they are

  /// May be called from several threads.
  ///
  /// @throws BakeError "solve.not-finite"
  std::vector<Goal> goals(std::span<const TransitionState> states) const;

  Goal goal(const TransitionState& T) const { return goals({&T, 1}).front(); }
};

/// States whose differences are blended as they are, without rotations.
StateSystem laplacian_states(const MorphableMesh& mesh, const Shares& reference,
                             std::unique_ptr<DisplacementSystem> displacements);

/// States whose differences are turned along. A reference that is a mix is solved for.
///
/// @param deformations  of the mesh's sources
/// @throws BakeError "linear.out-of-memory", "solve.no-convergence"; Cancelled
StateSystem rotation_states(const MorphableMesh& mesh,
                            const std::shared_ptr<const SourceDeformations>& deformations,
                            const Shares& reference,
                            std::unique_ptr<DisplacementSystem> displacements,
                            const SolveOptions& options, const Observer& observer);

}  // namespace morphbake
