#include "morphbake/solve/state_system.h"

#include <algorithm>
#include <utility>

#include "morphbake/solve/affine_blend.h"
#include "morphbake/solve/rigid_blend.h"
#include "morphbake/solve/solve_fields.h"

namespace morphbake {
namespace {

bool contains(const std::vector<bool>& flags, bool value) {
  return std::find(flags.begin(), flags.end(), value) != flags.end();
}

/// The sources mixed vertex by vertex; what is held as it stands.
Positions mixed_vertices(const DisplacementSystem& system, const MorphableMesh& mesh,
                         const TransitionState& T, const Positions& rest) {
  Positions mixed = Positions::Zero(rest.rows(), 3);
  for (std::size_t s = 0; s < mesh.geometries.size(); ++s) {
    mixed += T.row(static_cast<Eigen::Index>(s)).asDiagonal() * mesh.geometries[s];
  }
  for (Eigen::Index v = 0; v < mixed.rows(); ++v) {
    if (system.constraints().held[static_cast<std::size_t>(v)]) mixed.row(v) = rest.row(v);
  }
  return mixed;
}

/// One a component: whether all its vertices are one source.
std::vector<bool> are_sources(const Components& components, const TransitionState& T) {
  std::vector<bool> is_source(static_cast<std::size_t>(components.count), true);
  std::vector<Eigen::Index> first(is_source.size(), -1);
  for (Eigen::Index v = 0; v < T.cols(); ++v) {
    const auto component = static_cast<std::size_t>(components.label[static_cast<std::size_t>(v)]);
    if (first[component] < 0) first[component] = v;
    const bool is_one =
        (T.col(v).array() == 1).count() == 1 && (T.col(v).array() == 0).count() + 1 == T.rows();
    if (!is_one || T.col(v) != T.col(first[component])) is_source[component] = false;
  }
  return is_source;
}

/// Components in which all vertices are one source take it as it is.
std::vector<Goal> goals_of_rotations(const DisplacementSystem& system, const RotationBlend& blend,
                                     const MorphableMesh& mesh,
                                     std::span<const TransitionState> states,
                                     const Positions& rest) {
  std::vector<std::vector<bool>> known;
  std::vector<TransitionState> unknown;
  for (const TransitionState& T : states) {
    known.push_back(are_sources(system.components(), T));
    if (contains(known.back(), false)) unknown.push_back(T);
  }
  const std::vector<BlendedShape> shapes = blend.shapes(unknown);
  std::vector<Goal> goals;
  std::size_t next = 0;
  for (std::size_t i = 0; i < states.size(); ++i) {
    const Positions mixed = mixed_vertices(system, mesh, states[i], rest);
    if (!contains(known[i], false)) {
      goals.push_back(system.goal_of_shape(Positions::Zero(rest.rows(), 3), mixed,
                                           std::move(known[i]), rest, mixed));
      continue;
    }
    const BlendedShape& shape = shapes[next++];
    goals.push_back(system.goal_of_shape(shape.differences, mixed, std::move(known[i]), rest,
                                         shape.start.value_or(mixed)));
  }
  return goals;
}

/// Of a representation whose `shape(T, mixed)` needs no further solve. Sources are themselves, and
/// what is held is where it is.
template <typename Shape>
StateSystem states_of_shapes(const MorphableMesh& mesh, StateSystem states, const Shape& shape) {
  states.goals = [&mesh, rest = states.rest, &system = *states.displacements,
                  shape](std::span<const TransitionState> moments) {
    std::vector<Goal> goals;
    for (const TransitionState& T : moments) {
      Positions positions = mixed_vertices(system, mesh, T, rest);
      if (contains(are_sources(system.components(), T), false)) {
        const Positions blended = shape(T, positions);
        for (Eigen::Index v = 0; v < positions.rows(); ++v) {
          if (!system.constraints().held[static_cast<std::size_t>(v)]) {
            positions.row(v) = blended.row(v);
          }
        }
      }
      std::vector<bool> all(static_cast<std::size_t>(system.components().count), true);
      goals.push_back(system.goal_of_shape(Positions::Zero(rest.rows(), 3), positions,
                                           std::move(all), rest, positions));
    }
    return goals;
  };
  return states;
}

}  // namespace

StateSystem laplacian_states(const MorphableMesh& mesh, const Shares& reference,
                             std::unique_ptr<DisplacementSystem> displacements) {
  StateSystem states{reference, mixed_positions(mesh, reference), std::move(displacements), {}, {}};
  states.goals = [&system = *states.displacements,
                  start = uniform_transition(reference, mesh.connectivity.vertex_count)](
                     std::span<const TransitionState> moments) {
    std::vector<Goal> goals;
    for (const TransitionState& T : moments) goals.push_back(system.goal(T - start));
    return goals;
  };
  return states;
}

StateSystem rotation_states(const MorphableMesh& mesh,
                            const std::shared_ptr<const SourceDeformations>& deformations,
                            const Shares& reference,
                            std::unique_ptr<DisplacementSystem> displacements,
                            const SolveOptions& options, const Observer& observer) {
  StateSystem states = laplacian_states(mesh, reference, std::move(displacements));
  const DisplacementSystem& system = *states.displacements;
  const auto blend = std::make_shared<const RotationBlend>(
      mesh, deformations, system, reference.col(0),
      RotationBlend::Effort{allows_factor(system, options), options.frames, options.orders},
      observer);
  if (!system.holds()) states.factor = blend->factor();
  const bool is_mix = (reference.col(0).array() != 0).count() > 1;
  if (system.holds() && is_mix) {
    // What is held stands as the reference does when nothing is.
    Constraints free = system.constraints();
    free.held.assign(free.held.size(), false);
    const DisplacementSystem whole(mesh, std::move(free), options.right_hand_side);
    const std::vector<bool> none(static_cast<std::size_t>(whole.components().count), false);
    Goal goal = whole.goal_of_shape(blend->reference_differences(), states.rest, none, states.rest,
                                    states.rest);
    const SurfaceSolver solver(whole, options, observer);
    std::vector<SolveRecord> records;
    states.rest += solve_goal(solver, std::move(goal), "", records);
  }
  states.goals = [&mesh, &system, blend,
                  rest = states.rest](std::span<const TransitionState> moments) {
    return goals_of_rotations(system, *blend, mesh, moments, rest);
  };
  return states;
}

StateSystem affine_states(const MorphableMesh& mesh, const Shares& reference,
                          std::unique_ptr<DisplacementSystem> displacements) {
  StateSystem states = laplacian_states(mesh, reference, std::move(displacements));
  const auto blend =
      std::make_shared<const AffineBlend>(mesh, states.displacements->constraints(), states.rest);
  return states_of_shapes(
      mesh, std::move(states),
      [blend](const TransitionState& T, const Positions& mixed) { return blend->shape(T, mixed); });
}

StateSystem absolute_states(const MorphableMesh& mesh, const Shares& reference,
                            std::unique_ptr<DisplacementSystem> displacements) {
  return states_of_shapes(mesh, laplacian_states(mesh, reference, std::move(displacements)),
                          [](const TransitionState&, const Positions& mixed) { return mixed; });
}

StateSystem rigid_states(const MorphableMesh& mesh, const Shares& reference,
                         std::unique_ptr<DisplacementSystem> displacements) {
  const auto blend = std::make_shared<const RigidBlend>(mesh, displacements->constraints().gauge);
  return states_of_shapes(
      mesh, laplacian_states(mesh, reference, std::move(displacements)),
      [blend](const TransitionState& T, const Positions&) { return blend->shape(T); });
}

}  // namespace morphbake
