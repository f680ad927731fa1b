#include "morphbake/bake/output_morph.h"

#include <algorithm>
#include <utility>

namespace morphbake {
namespace {

Positions still_positions(const SolvedRecipe& solved, const Still& still,
                          const SolveOptions& options) {
  const Recipe& recipe = solved.recipe;
  if (const double* time = std::get_if<double>(&still.at)) {
    return position_at(recipe, solved.mesh, solved.regions, solved.timeline, *time);
  }
  const State& state = recipe.states[static_cast<std::size_t>(std::get<int>(still.at))];
  return solve_state(solved, state, options);
}

/// At the vertices of the first source's file, or no rows where colours do not change.
Positions colours_at(const SolvedRecipe& solved, double time) {
  if (solved.colours.empty()) return {};
  return mixed_colours(
      solved.colours, solved.mesh,
      transition_at(solved.recipe, solved.regions, solved.mesh.connectivity.vertex_count, time));
}

Positions still_colours(const SolvedRecipe& solved, const Still& still) {
  if (const double* time = std::get_if<double>(&still.at)) return colours_at(solved, *time);
  if (solved.colours.empty()) return {};
  const Recipe& recipe = solved.recipe;
  const State& state = recipe.states[static_cast<std::size_t>(std::get<int>(still.at))];
  return mixed_colours(
      solved.colours, solved.mesh,
      state_transition(state, solved.regions, solved.mesh.connectivity.vertex_count));
}

/// The motion with progress and a place to stop at each moment that is asked for: once a frame for
/// normals, twice for the measurement.
ReferenceMotion watched(const ReferenceMotion& motion, const Observer& observer) {
  const auto total = static_cast<int>(3 * motion.frame_times.size());
  const auto done = std::make_shared<int>(0);
  return {motion.frame_times, [motion, &observer, total, done](double time) {
            advance(observer, {"export", std::min((*done)++, total), total});
            return motion.positions_at(time);
          }};
}

/// @param tolerance  of positions, scene units
MorphBasis basis_of(const SolvedTimeline& timeline, const Timeline& of, const OutputInputs& inputs,
                    double tolerance) {
  const std::vector<Clip>& clips = inputs.output.clips;
  switch (inputs.kind) {
    case TargetKind::Tracks:
      return track_basis(timeline.shapes, *timeline.separable, of, clips, inputs.options.basis);
    case TargetKind::Keyframes:
      return keyframe_basis(timeline.frames, tolerance, clips, inputs.observer);
    case TargetKind::Basis:
      return principal_basis(timeline.frames, tolerance, clips, inputs.observer);
    case TargetKind::Auto:
      return smallest_basis(timeline.frames, tolerance, clips, inputs.observer);
    case TargetKind::Frames:
      break;
  }
  return frame_basis(timeline.frames, clips);
}

}  // namespace

MorphWithMotions make_still_output(const SolvedRecipe& solved, const Still& still,
                                   const SolveOptions& options) {
  const Positions positions = still_positions(solved, still, options);
  return {
      make_still(solved.first, solved.mesh, solved.groups, positions, still_colours(solved, still)),
      nullptr,
      {{{0.0}, [positions](double) { return positions; }}},
      "still"};
}

TargetKind kind_of(const Output& output, const SolvedTimeline& timeline) {
  const bool has_tracks = timeline.shapes.base.rows() > 0;
  if (output.targets != TargetKind::Auto) return output.targets;
  return has_tracks ? TargetKind::Tracks : TargetKind::Auto;
}

MorphBasis smallest_basis(const FrameSource& frames, double tolerance,
                          const std::vector<Clip>& clips, const Observer& observer) {
  MorphBasis keyframes = keyframe_basis(frames, tolerance, clips, observer);
  if (frames.times.size() > kMostFramesOfBasis) return keyframes;
  MorphBasis principal = principal_basis(frames, tolerance, clips, observer);
  return principal.targets.size() < keyframes.targets.size() ? std::move(principal)
                                                             : std::move(keyframes);
}

MorphWithMotions make_animated_output(const SolvedRecipe& solved, const OutputInputs& inputs,
                                      double tolerance) {
  const Timeline& timeline = solved.recipe.timeline;
  const SolvedTimeline& of = solved.timeline;
  const bool by_track = inputs.kind == TargetKind::Tracks;
  MorphWithMotions made;
  made.timeline = std::make_unique<ReferenceMotion>(watched(
      by_track ? continuous_motion(of.shapes, *of.separable, timeline) : stepped_motion(of.frames),
      inputs.observer));
  if (!solved.colours.empty()) {
    made.timeline->colours_at = [&solved](double time) { return colours_at(solved, time); };
    made.timeline->first_colours = colours_at(solved, 0);
  }
  for (const Clip& clip : inputs.output.clips) {
    made.motions.push_back(motion_of(*made.timeline, clip));
  }
  const MorphBasis basis = basis_of(of, timeline, inputs, tolerance);
  made.kind = name_of(basis.kind);
  // Integers cannot exceed 1. Where they do not have to be small, such targets may stay floats.
  const bool is_small = inputs.output.encoding == Encoding::Meshopt;
  made.morph = make_mesh_morph(solved.first, solved.mesh, basis, solved.groups, made.motions,
                               is_small ? TargetRange::Unit : TargetRange::Any);
  return made;
}

}  // namespace morphbake
