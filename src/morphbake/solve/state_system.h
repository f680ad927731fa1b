#pragma once

#include <functional>
#include <memory>
#include <span>
#include <vector>

#include "morphbake/diagnostics/observer.h"
#include "morphbake/linear/cholesky_factor.h"
#include "morphbake/solve/displacement_system.h"
#include "morphbake/solve/rotation_blend.h"
#include "morphbake/transition/timeline.h"

namespace morphbake {

/// A displacement system, and how transition states become its goals.
struct StateSystem {
  Shares reference;  ///< the same at every vertex; what is held has them at all times
  Positions rest;    ///< #V by 3: the reference's shape, from which displacements start
  std::unique_ptr<DisplacementSystem> displacements;
  /// Of the displacements' equations, in float32, where the goals need it; else none.
  std::shared_ptr<const CholeskyFactor> factor;
  /// One goal a state. May be called from several threads.
  std::function<std::vector<Goal>(std::span<const TransitionState>)> goals;

  Goal goal(const TransitionState& T) const { return goals({&T, 1}).front(); }
};

// Each of these lets the mesh and its system be used by the goals: the mesh must outlive the
// result. Goals throw BakeError "solve.not-finite".

/// Differences along edges are blended as they are.
/// @see Alexa 2003, section 4.1
StateSystem laplacian_states(const MorphableMesh& mesh, const Shares& reference,
                             std::unique_ptr<DisplacementSystem> displacements);

/// Differences are turned along. A reference that is a mix is solved for.
///
/// @param deformations  of the mesh's sources
/// @param observer      must outlive the result
/// @throws BakeError "linear.out-of-memory", "solve.no-convergence"; Cancelled
StateSystem rotation_states(const MorphableMesh& mesh,
                            const std::shared_ptr<const SourceDeformations>& deformations,
                            const Shares& reference,
                            std::unique_ptr<DisplacementSystem> displacements,
                            const SolveOptions& options, const Observer& observer);

/// Every vertex as a weighted sum of its neighbours (see AffineBlend). Goals are solved already.
/// @see Alexa 2003, section 4.2
StateSystem affine_states(const MorphableMesh& mesh, const Shares& reference,
                          std::unique_ptr<DisplacementSystem> displacements);

/// Positions, interpolated as they are.
StateSystem absolute_states(const MorphableMesh& mesh, const Shares& reference,
                            std::unique_ptr<DisplacementSystem> displacements);

/// Positions of sources that were brought together by motions (see RigidBlend).
StateSystem rigid_states(const MorphableMesh& mesh, const Shares& reference,
                         std::unique_ptr<DisplacementSystem> displacements);

}  // namespace morphbake
