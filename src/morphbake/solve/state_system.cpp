#include "morphbake/solve/state_system.h"

#include <utility>

#include "morphbake/solve/solve_fields.h"

namespace morphbake {

std::vector<Goal> StateSystem::goals(std::span<const TransitionState> states) const {
  if (rotations) return goals_of_rotations(*displacements, *rotations, mesh, states, rest);
  const TransitionState start = uniform_transition(reference, mesh.connectivity.vertex_count);
  std::vector<Goal> goals;
  for (const TransitionState& T : states) goals.push_back(displacements->goal(T - start));
  return goals;
}

StateSystem laplacian_states(const MorphableMesh& mesh, const Shares& reference,
                             std::unique_ptr<DisplacementSystem> displacements) {
  return {mesh, reference, mixed_positions(mesh, reference), std::move(displacements), nullptr};
}

StateSystem rotation_states(const MorphableMesh& mesh,
                            const std::shared_ptr<const SourceDeformations>& deformations,
                            const Shares& reference,
                            std::unique_ptr<DisplacementSystem> displacements,
                            const SolveOptions& options, const Observer& observer) {
  StateSystem states = laplacian_states(mesh, reference, std::move(displacements));
  states.rotations = std::make_unique<RotationBlend>(
      mesh, deformations, states.displacements->constraints(), reference.col(0));
  if (!states.displacements->holds()) return states;
  // What is held stands as the reference does when nothing is.
  Constraints free = states.displacements->constraints();
  free.held.assign(free.held.size(), false);
  const RotationBlend blend(mesh, deformations, free, reference.col(0));
  const DisplacementSystem system(mesh, std::move(free), options.right_hand_side);
  const TransitionState T = uniform_transition(reference, mesh.connectivity.vertex_count);
  Goal goal = goals_of_rotations(system, blend, mesh, {&T, 1}, states.rest).front();
  if (goal.is_blend()) return states;
  const SurfaceSolver solver(system, options, observer);
  std::vector<SolveRecord> records;
  states.rest += solve_goal(solver, std::move(goal), "", records);
  return states;
}

}  // namespace morphbake
