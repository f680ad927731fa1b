#include "morphbake/bake/solve_timeline.h"

#include <fmt/core.h>

#include <optional>
#include <utility>

#include "morphbake/bake/anchor_spike.h"
#include "morphbake/bake/kept_stages.h"
#include "morphbake/bake/solved_recipe.h"
#include "morphbake/bake/timeline_changes.h"
#include "morphbake/bake/timeline_system.h"
#include "morphbake/json/json.h"

namespace morphbake {
namespace {

/// What states of any kind need, but for their own shares.
struct Solving {
  const MorphableMesh& mesh;
  const RepresentationChoice& choice;
  const SolveOptions& options;
  const Observer& observer;
};

StateSystem make_states(const Solving& solving, const Shares& reference,
                        std::unique_ptr<DisplacementSystem> system) {
  const auto& [mesh, choice, options, observer] = solving;
  switch (choice.representation) {
    case Representation::Rotation:
      return rotation_states(mesh, choice.deformations, reference, std::move(system), options,
                             observer);
    case Representation::Affine:
      return affine_states(mesh, reference, std::move(system));
    case Representation::Absolute:
      return absolute_states(mesh, reference, std::move(system));
    case Representation::Rigid:
      return rigid_states(mesh, reference, std::move(system));
    default:
      return laplacian_states(mesh, reference, std::move(system));
  }
}

/// Refuses targets that are shapes, for a reason: without shapes there are only frames.
void refuse_tracks(const Recipe& recipe, const std::string& reason) {
  for (std::size_t i = 0; i < recipe.outputs.size(); ++i) {
    const Output& output = recipe.outputs[i];
    if (output.still || output.targets != TargetKind::Tracks) continue;
    throw BakeError(Problem{Severity::Error, "recipe.needs-frames",
                            location_in(recipe, child_pointer("/outputs", i) + "/targets"),
                            "\"tracks\" targets are shapes that are solved once; " + reason,
                            "write \"targets\": \"frames\""});
  }
}

/// What must stand still: held and gauge regions, and regions of states that become stills.
void check_still_regions(const Recipe& recipe, const RegionFields& regions) {
  std::vector<Problem> problems;
  const auto check = [&](int region, bool may_flood, const std::string& pointer) {
    if (region < 0) return;
    const RegionField& field = regions[static_cast<std::size_t>(region)];
    if (!field.moves && (may_flood || !field.floods)) return;
    problems.push_back(
        {Severity::Error, "recipe.moving-region", location_in(recipe, pointer),
         fmt::format("the region {} changes with time", recipe.regions[region].name),
         "name a region that stands still here; a still may name a time instead of a state"});
  };
  for (std::size_t i = 0; i < recipe.hold.regions.size(); ++i) {
    check(recipe.hold.regions[i], false, child_pointer("/hold", i));
  }
  if (recipe.gauge.kind == Gauge::Kind::Region) check(recipe.gauge.region, false, "/gauge/region");
  for (std::size_t i = 0; i < recipe.outputs.size(); ++i) {
    const auto& still = recipe.outputs[i].still;
    if (!still || !std::holds_alternative<int>(still->at)) continue;
    for (const Edit& edit :
         recipe.states[static_cast<std::size_t>(std::get<int>(still->at))].edits) {
      check(edit.region, true, child_pointer("/outputs", i) + "/still/at");
    }
  }
  if (!problems.empty()) throw BakeError(std::move(problems));
}

/// The options, with every frame solved where there is no other way.
SolveOptions options_for(const Recipe& recipe, Representation representation,
                         const TimelineChanges& changes, SolveOptions options) {
  options.every_frame =
      options.every_frame || !changes.separable || representation != Representation::Laplacian;
  if (options.every_frame) options.frames = static_cast<int>(frame_times(recipe.timeline).size());
  return options;
}

/// A recipe, and its regions on so many vertices.
struct RecipeOnMesh {
  const Recipe& recipe;
  const RegionFields& regions;
  Eigen::Index count;
};

/// The timeline as shapes, where it is made of them, once all is checked.
std::optional<SeparableTimeline> shapes_of(const RecipeOnMesh& given, Representation representation,
                                           const SolveOptions& options, const Observer& observer) {
  const auto& [recipe, regions, count] = given;
  check_still_regions(recipe, regions);
  if (options.every_frame) {
    refuse_tracks(recipe, "the option /solve/every_frame solves frames instead");
  }
  if (!is_separable(recipe, regions)) {
    refuse_tracks(recipe, "here a region moves or floods, so every frame is another");
    return std::nullopt;
  }
  if (representation != Representation::Laplacian) {
    refuse_tracks(recipe, fmt::format("the representation \"{}\" solves every frame",
                                      name_of(representation)));
  }
  std::optional<SeparableTimeline> separable = separate_timeline(recipe, regions, count);
  if (separable) return separable;
  const std::string reason = fmt::format(
      "more than {} are needed here: one a track, and one for each combination of "
      "tracks that overlap in space and time",
      kMostFields - 1);
  refuse_tracks(recipe, reason);
  report(observer,
         Problem{Severity::Warning, "transition.too-many-overlaps",
                 location_in(recipe, "/timeline/tracks"),
                 "frames are solved instead of tracks' shapes: " + reason,
                 "use fewer tracks, and let those that share a region follow one another"});
  return std::nullopt;
}

template <typename Matrix>
std::string hash_of(const Matrix& matrix) {
  const auto* begin = reinterpret_cast<const char*>(matrix.data());
  return content_hash({begin, static_cast<std::size_t>(matrix.size()) * sizeof(double)});
}

SolveReport report_of(const SolvedTimeline& solved, const SurfaceSolver& solver,
                      std::vector<SolveRecord> records) {
  const DisplacementSystem& system = *solved.states->displacements;
  SolveReport report;
  report.representation = name_of(solved.representation.representation);
  report.representation_reason = solved.representation.reason;
  report.solver = name_of(solver.choice().solver);
  report.reason = solver.choice().reason;
  report.unknowns = static_cast<int>(system.equations().matrix.rows());
  report.held = system.held_count();
  report.factor_bytes = solver.factor_bytes();
  report.solves = std::move(records);
  if (system.diagonal() > 0) {
    for (SolveRecord& record : report.solves) record.convergence.error /= system.diagonal();
  }
  return report;
}

/// The hash of all numbers that shapes come from.
std::string hash_of(const MorphableMesh& mesh, const SeparableTimeline& separable) {
  std::string hashes = hash_of(separable.reference);
  for (const Positions& positions : mesh.geometries) hashes += hash_of(positions);
  for (const TransitionField& field : separable.fields) {
    hashes += hash_of(field.change) + content_hash(field.name);
  }
  return content_hash(hashes);
}

KeptShapes solved_shapes(const MorphableMesh& mesh, const SolveOptions& options,
                         const Observer& observer, const SolvedTimeline& solved) {
  const StateSystem& states = *solved.states;
  const SurfaceSolver solver(*states.displacements, options, observer, states.factor);
  SolvedShapes shapes = solve_fields(solver, mesh, *solved.separable, observer);
  SolveReport report = report_of(solved, solver, std::move(shapes.records));
  return {std::move(shapes), std::move(report)};
}

/// Solves for the shapes of which the timeline is made, or takes them from the cache: when frames
/// come is nothing to them.
void solve_shapes(const Recipe& recipe, const MorphableMesh& mesh, const SolveOptions& options,
                  const StageContext& context, SolvedTimeline& solved) {
  StageKey key = context.keys.shapes;
  if (context.cache.is_on()) key.key = content_hash(key.key + hash_of(mesh, *solved.separable));
  KeptShapes kept = taken_or_made(
      context.cache, key, context.observer,
      [&](const Observer& listening) { return solved_shapes(mesh, options, listening, solved); },
      [&](const CacheEntry& entry) {
        return shapes_of(entry, solved.separable->fields.size(), mesh.connectivity.vertex_count);
      });
  solved.shapes = std::move(kept.shapes);
  solved.report = std::move(kept.report);
  solved.frames = combined_frames(solved.shapes, *solved.separable, recipe.timeline);
}

void solve_every_frame(const Recipe& recipe, const RegionFields& regions,
                       const SolveOptions& options, const Observer& observer,
                       SolvedTimeline& solved) {
  const StateSystem& states = *solved.states;
  const Eigen::Index count = states.rest.rows();
  solved.solver =
      std::make_unique<SurfaceSolver>(*states.displacements, options, observer, states.factor);
  const auto goals_at = [&](std::span<const double> times) {
    std::vector<TransitionState> moments;
    for (const double time : times) {
      moments.push_back(transition_at(recipe, regions, count, time));
    }
    return states.goals(moments);
  };
  SolvedFrames frames =
      solved_frames(*solved.solver, states.rest, frame_times(recipe.timeline), goals_at, observer);
  solved.frames = std::move(frames.source);
  solved.report = report_of(solved, *solved.solver, std::move(frames.records));
}

}  // namespace

void check_timeline(const Recipe& recipe, const MorphableMesh& mesh, const RegionFields& regions,
                    const SolveOptions& options, const Observer& observer) {
  const Eigen::Index count = mesh.connectivity.vertex_count;
  const Representation representation =
      choose_representation(recipe, mesh, observer).representation;
  const TimelineChanges changes =
      changes_of(recipe, regions, count,
                 shapes_of({recipe, regions, count}, representation, options, observer), observer);
  choose_solver(*timeline_system(recipe, mesh, regions, changes, options),
                options_for(recipe, representation, changes, options));
}

std::unique_ptr<SolvedTimeline> solve_timeline(const Recipe& recipe, const MorphableMesh& mesh,
                                               const RegionFields& regions,
                                               const SolveOptions& options,
                                               const StageContext& context) {
  const Observer& observer = context.observer;
  const Eigen::Index count = mesh.connectivity.vertex_count;
  auto solved = std::make_unique<SolvedTimeline>();
  solved->representation = choose_representation(recipe, mesh, observer);
  const Representation representation = solved->representation.representation;
  TimelineChanges changes =
      changes_of(recipe, regions, count,
                 shapes_of({recipe, regions, count}, representation, options, observer), observer);
  const SolveOptions solving = options_for(recipe, representation, changes, options);
  solved->states = std::make_unique<StateSystem>(
      make_states({mesh, solved->representation, solving, observer}, changes.reference,
                  timeline_system(recipe, mesh, regions, changes, options)));
  solved->separable = std::move(changes.separable);
  if (solving.every_frame) {
    solve_every_frame(recipe, regions, solving, observer, *solved);
  } else {
    solve_shapes(recipe, mesh, solving, context, *solved);
  }
  warn_of_spike(recipe, mesh, *solved, changes, observer);
  return solved;
}

Positions position_at(const Recipe& recipe, const MorphableMesh& mesh, const RegionFields& regions,
                      const SolvedTimeline& solved, double time) {
  if (solved.shapes.base.rows() > 0) {
    return combine_shapes(solved.shapes,
                          field_coefficients(recipe.timeline, *solved.separable, time));
  }
  const Eigen::Index count = mesh.connectivity.vertex_count;
  std::vector<SolveRecord> records;
  return solved.states->rest +
         solve_goal(*solved.solver,
                    solved.states->goal(transition_at(recipe, regions, count, time)), "", records);
}

Positions solve_state(const SolvedRecipe& solved, const State& state, const SolveOptions& options) {
  const auto& recipe = solved.recipe;
  const auto& mesh = solved.mesh;
  const auto& regions = solved.regions;
  const Eigen::Index count = mesh.connectivity.vertex_count;
  const TimelineChanges changes = changes_of_fields(separate_state(state, regions, count));
  const Observer nobody;
  const StateSystem states =
      make_states({mesh, solved.timeline.representation, options, nobody}, changes.reference,
                  timeline_system(recipe, mesh, regions, changes, options));
  const SurfaceSolver solver(*states.displacements, options, nobody);
  std::vector<SolveRecord> records;
  return states.rest + solve_goal(solver, states.goal(state_transition(state, regions, count)),
                                  state.name, records);
}

}  // namespace morphbake
