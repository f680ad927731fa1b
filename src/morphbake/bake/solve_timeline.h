#pragma once

#include <memory>
#include <optional>

#include "morphbake/bake/bake.h"
#include "morphbake/bake/bake_cache.h"
#include "morphbake/bake/choose_representation.h"
#include "morphbake/solve/frame_source.h"
#include "morphbake/solve/state_system.h"

namespace morphbake {

struct SolvedRecipe;

/// A timeline, solved: its shapes where it is made of them, else its frames alone.
struct SolvedTimeline {
  RepresentationChoice representation;
  std::optional<SeparableTimeline> separable;  ///< none when regions move or flood, or too many
  std::unique_ptr<StateSystem> states;
  std::unique_ptr<SurfaceSolver> solver;  ///< of frames; none where shapes make up the timeline
  SolvedShapes shapes;                    ///< empty when frames were solved
  FrameSource frames;
  SolveReport report;
};

/// Chooses what is held and where the rest stands, factorises, solves. Shapes that the cache has
/// are not solved for.
///
/// @throws BakeError "recipe.held-region-changes", "recipe.moving-region", "recipe.needs-frames",
///         "options.cannot-hold", "solve.no-convergence"
std::unique_ptr<SolvedTimeline> solve_timeline(const Recipe& recipe, const MorphableMesh& mesh,
                                               const RegionFields& regions,
                                               const SolveOptions& options,
                                               const StageContext& context);

/// Finds what solve_timeline would refuse before it solves.
///
/// @throws BakeError "recipe.held-region-changes", "recipe.moving-region", "recipe.needs-frames",
///         "options.cannot-hold"; Cancelled
void check_timeline(const Recipe& recipe, const MorphableMesh& mesh, const RegionFields& regions,
                    const SolveOptions& options, const Observer& observer);

/// The shape of the timeline at `time`: #V by 3, scene space.
Positions position_at(const Recipe& recipe, const MorphableMesh& mesh, const RegionFields& regions,
                      const SolvedTimeline& solved, double time);

/// Shape of one state, whose regions stand still, held and gauged for itself.
///
/// @return #V by 3, scene space
Positions solve_state(const SolvedRecipe& solved, const State& state, const SolveOptions& options);

}  // namespace morphbake
