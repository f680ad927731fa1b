#include "morphbake/bake/outputs.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <utility>

#include "morphbake/bake/encode_output.h"
#include "morphbake/mesh/measures.h"

namespace morphbake {
namespace {

// What three.js and Babylon.js read at most.
constexpr std::size_t kEngineTargetLimit = 255;

Positions still_positions(const SolvedRecipe& solved, const Still& still,
                          const SolveOptions& options) {
  const Recipe& recipe = solved.recipe;
  if (const double* time = std::get_if<double>(&still.at)) {
    return position_at(recipe, solved.mesh, solved.regions, solved.timeline, *time);
  }
  const State& state = recipe.states[static_cast<std::size_t>(std::get<int>(still.at))];
  return solve_state(recipe, state, solved.mesh, solved.regions, solved.timeline.representation,
                     options);
}

/// #V by 3, or no rows where colours do not change.
Positions colours_at(const SolvedRecipe& solved, double time) {
  if (solved.colours.empty()) return {};
  return mixed_colours(solved.colours, transition_at(solved.recipe, solved.regions,
                                                     solved.mesh.connectivity.vertex_count, time));
}

Positions still_colours(const SolvedRecipe& solved, const Still& still) {
  if (const double* time = std::get_if<double>(&still.at)) return colours_at(solved, *time);
  if (solved.colours.empty()) return {};
  const Recipe& recipe = solved.recipe;
  const State& state = recipe.states[static_cast<std::size_t>(std::get<int>(still.at))];
  return mixed_colours(solved.colours, state_transition(state, solved.regions,
                                                        solved.mesh.connectivity.vertex_count));
}

void warn_of_no_targets(const Recipe& recipe, std::size_t index, const Observer& observer) {
  report(observer,
         Problem{Severity::Warning, "basis.nothing-moves",
                 location_in(recipe, fmt::format("/outputs/{}", index)),
                 "no track or key changes any vertex: the file is a plain mesh",
                 "check that regions reach vertices, and that tracks lead to another source"});
}

/// @param count  targets of the mesh that is written: its own and the new ones
void warn_of_targets(const SolvedRecipe& solved, std::size_t index, std::size_t count,
                     const Observer& observer) {
  if (count <= kEngineTargetLimit) return;
  report(observer, Problem{Severity::Warning, "export.many-targets",
                           location_in(solved.recipe, fmt::format("/outputs/{}/targets", index)),
                           fmt::format("{} morph targets; three.js and Babylon.js read at most {}",
                                       count, kEngineTargetLimit),
                           solved.timeline.shapes.base.rows() > 0
                               ? "use \"targets\": \"tracks\", a lower fps or a shorter timeline"
                               : "use a lower fps or a shorter timeline"});
}

/// Posed vertices must not be posed again.
void warn_of_skin(const SolvedRecipe& solved, const Observer& observer) {
  const SourceGeometry& geometry = solved.first.geometry;
  if (!geometry.is_posed) return;
  report(observer,
         Problem{Severity::Warning,
                 "gltf.skin-dropped",
                 {file_of(solved.first.file), fmt::format("/nodes/{}/skin", geometry.node), 0, 0},
                 "the first source is posed by its skeleton, so the mesh that is written has no "
                 "skin",
                 "name a source in its rest pose first to keep the skin"});
}

/// Tells that a bound is not kept: an error, or a warning where the recipe says so.
void tell_unmet(const Output& output, Problem problem, const Observer& observer) {
  problem.severity = output.unmet_is_error ? Severity::Error : Severity::Warning;
  if (output.unmet_is_error) throw BakeError(std::move(problem));
  report(observer, problem);
}

bool keeps_positions(const Output& output, const OutputReport& written) {
  return written.max_error <= output.max_error;
}

bool keeps_normals(const Output& output, const NormalReport& normals) {
  const NormalBounds& bounds = output.max_normal_error;
  return normals.maximum <= bounds.maximum.value_or(180) &&
         normals.percentile_99 <= bounds.percentile_99.value_or(180);
}

void check_positions(const Recipe& recipe, std::size_t index, const OutputReport& written,
                     const Observer& observer) {
  const Output& output = recipe.outputs[index];
  if (keeps_positions(output, written)) return;
  Problem problem{
      Severity::Error, "export.position-error",
      location_in(recipe, fmt::format("/outputs/{}/max_error", index)),
      fmt::format("positions are up to {:.3g} of the diagonal off, more than the {:.3g} "
                  "that are allowed; worst at vertex {} and {:.4g} s",
                  written.max_error, output.max_error, written.worst_vertex, written.worst_time),
      "\"targets\": \"frames\" is as exact as float32; a larger bound, or \"unmet\": "
      "\"warning\", accepts it"};
  tell_unmet(output, std::move(problem), observer);
}

void check_normals(const Recipe& recipe, std::size_t index, const NormalReport& normals,
                   const Observer& observer) {
  const Output& output = recipe.outputs[index];
  if (keeps_normals(output, normals)) return;
  const NormalBounds& bounds = output.max_normal_error;
  const bool is_whole = normals.maximum <= bounds.maximum.value_or(180);
  const double bound = is_whole ? *bounds.percentile_99 : *bounds.maximum;
  Problem problem{
      Severity::Error, "export.normal-error",
      location_in(recipe, fmt::format("/outputs/{}/max_normal_error", index)),
      fmt::format(
          "normals are up to {:.2f} degrees off ({:.2f} for 99 in 100), more than the {:.4g} "
          "that are allowed; worst at vertex {} and {:.4g} s",
          normals.maximum, normals.percentile_99, bound, normals.vertex, normals.time),
      "\"targets\": \"frames\" follows normals closer than \"tracks\"; a larger bound, or "
      "\"unmet\": \"warning\", accepts it"};
  tell_unmet(output, std::move(problem), observer);
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

/// A morph and the motion that each of its clips is to show; of a still, that it does not move.
struct MorphWithMotions {
  MeshMorph morph;
  std::unique_ptr<ReferenceMotion> timeline;  ///< of which the motions are parts
  std::vector<ReferenceMotion> motions;
  std::string kind;  ///< of targets, as recipes write it, or "still"
};

MorphWithMotions make_still_output(const SolvedRecipe& solved, const Still& still,
                                   const SolveOptions& options) {
  const Positions positions = still_positions(solved, still, options);
  return {
      make_still(solved.first, solved.mesh, solved.groups, positions, still_colours(solved, still)),
      nullptr,
      {{{0.0}, [positions](double) { return positions; }}},
      "still"};
}

/// The kind that is asked for, where a timeline without tracks has none.
TargetKind kind_of(const Output& output, const SolvedTimeline& timeline) {
  const bool has_tracks = timeline.shapes.base.rows() > 0;
  if (output.targets != TargetKind::Auto) return output.targets;
  return has_tracks ? TargetKind::Tracks : TargetKind::Auto;
}

/// A morph is as large as it has targets. Of keyframes two are active at any time, of a basis all.
MorphBasis smallest_basis(const FrameSource& frames, double tolerance,
                          const std::vector<Clip>& clips, const Observer& observer) {
  MorphBasis keyframes = keyframe_basis(frames, tolerance, clips, observer);
  if (frames.times.size() > kMostFramesOfBasis) return keyframes;
  MorphBasis principal = principal_basis(frames, tolerance, clips, observer);
  return principal.targets.size() < keyframes.targets.size() ? std::move(principal)
                                                             : std::move(keyframes);
}

/// What an output is made from, beside the recipe.
struct OutputInputs {
  const Output& output;
  const BakeOptions& options;
  const Observer& observer;
};

/// @param tolerance  of positions, scene units
MorphBasis basis_of(const SolvedTimeline& timeline, const Timeline& of, const OutputInputs& inputs,
                    double tolerance) {
  const std::vector<Clip>& clips = inputs.output.clips;
  switch (kind_of(inputs.output, timeline)) {
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

MorphWithMotions make_animated_output(const SolvedRecipe& solved, const OutputInputs& inputs,
                                      double tolerance) {
  const Timeline& timeline = solved.recipe.timeline;
  const SolvedTimeline& of = solved.timeline;
  const bool by_track = kind_of(inputs.output, of) == TargetKind::Tracks;
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
  made.morph = make_mesh_morph(solved.first, solved.mesh, basis, solved.groups, made.motions);
  return made;
}

/// How far the clips of what was written are from their motions.
MorphError measure_clips(const SolvedRecipe& solved, WrittenMesh& written,
                         const std::vector<ReferenceMotion>& motions) {
  MorphError worst;
  for (std::size_t c = 0; c < motions.size(); ++c) {
    written.mesh.weights = written.clips[c];
    const MorphError error =
        measure_mesh_morph(solved.mesh, written.mesh, solved.groups, motions[c]);
    if (c == 0 || error.distance > worst.distance) {
      worst.distance = error.distance;
      worst.distance_time = error.distance_time;
      worst.distance_vertex = error.distance_vertex;
    }
    if (c == 0 || error.normal_angle > worst.normal_angle) {
      worst.normal_angle = error.normal_angle;
      worst.normal_time = error.normal_time;
      worst.normal_vertex = error.normal_vertex;
    }
    worst.normal_angle_99 = std::max(worst.normal_angle_99, error.normal_angle_99);
  }
  return worst;
}

/// An output's bytes, and what was measured on them.
struct WrittenOutput {
  std::string bytes;
  OutputReport report;
  int node = 0;
  std::size_t all_targets = 0;  ///< with those that the mesh had
};

WrittenOutput write_output(const SolvedRecipe& solved, const Output& output,
                           MorphWithMotions made) {
  auto& [morph, timeline, motions, kind] = made;
  const auto added = static_cast<std::ptrdiff_t>(morph.target_names.size());
  const std::size_t clips = added > 0 ? morph.clips.size() : 0;
  const double diagonal = bounding_diagonal(motions.front().positions_at(0));
  WrittenOutput result;
  OutputReport& report = result.report;
  for (const MorphClip& clip : morph.clips) {
    report.weight_keys += static_cast<int>(clip.key_times.size());
  }
  EncodedOutput encoded = encode_output(solved.first, output, diagonal, std::move(morph));
  result.bytes = std::move(encoded.glb);  // what they say is measured
  result.node = encoded.node;
  WrittenMesh written = read_written_mesh(result.bytes, output.file, encoded.node, clips);
  restore_order(encoded.old_vertex, written.mesh);
  const std::vector<std::string>& names = written.mesh.target_names;
  result.all_targets = names.size();
  // Without targets nothing moves, and one weight at rest stands for all clips.
  written.clips.resize(motions.size(), written.clips.front());
  const MorphError error = measure_clips(solved, written, motions);

  report.file = output.file;
  report.kind = kind;
  report.bytes = result.bytes.size();
  report.targets.assign(names.end() - added, names.end());
  report.max_error = diagonal > 0 ? error.distance / diagonal : 0;
  report.worst_time = error.distance_time;
  report.worst_vertex = error.distance_vertex;
  report.normals = {error.normal_angle, error.normal_angle_99, error.normal_time,
                    error.normal_vertex};
  return result;
}

bool keeps_bounds(const Output& output, const OutputReport& written) {
  return keeps_positions(output, written) && keeps_normals(output, written.normals);
}

/// Fewer targets that keep the bounds, as those of one tolerance do and those of another do not.
///
/// @param write  an output whose targets are chosen for a tolerance
WrittenOutput fewest_targets(const Output& output, double failing, double keeping,
                             std::size_t failing_targets, WrittenOutput kept,
                             const std::function<WrittenOutput(double tolerance)>& write) {
  constexpr int kHalvings = 3;
  for (int i = 0; i < kHalvings && failing_targets + 1 < kept.all_targets; ++i) {
    const double middle = std::sqrt(failing * keeping);
    WrittenOutput tried = write(middle);
    if (keeps_bounds(output, tried.report)) {
      keeping = middle;
      kept = std::move(tried);
    } else {
      failing = middle;
      failing_targets = tried.all_targets;
    }
  }
  return kept;
}

/// The output with as few targets as keep its bounds; where they are not to be kept, with as many
/// as frames give or the tolerance reaches.
WrittenOutput write_animated_output(const SolvedRecipe& solved, const OutputInputs& inputs) {
  constexpr double kTighter = 0.6;
  constexpr int kMostTightenings = 20;  // 4e-5 of the bound
  const Output& output = inputs.output;
  const TargetKind kind = kind_of(output, solved.timeline);
  const std::size_t frames = solved.timeline.frames.times.size();
  const auto write = [&](double tolerance) {
    return write_output(solved, output, make_animated_output(solved, inputs, tolerance));
  };
  double tolerance = output.max_error * bounding_diagonal(solved.timeline.frames.positions(0));
  WrittenOutput written = write(tolerance);
  if (kind == TargetKind::Tracks || kind == TargetKind::Frames) return written;
  for (int i = 0; i < kMostTightenings && !keeps_bounds(output, written.report); ++i) {
    if (written.report.targets.size() + 1 >= frames) break;
    const double failing = tolerance;
    const std::size_t failing_targets = written.all_targets;
    tolerance *= kTighter;
    written = write(tolerance);
    if (!keeps_bounds(output, written.report)) continue;
    return fewest_targets(output, failing, tolerance, failing_targets, std::move(written), write);
  }
  return written;
}

}  // namespace

StagedOutput stage_output(const SolvedRecipe& solved, std::size_t index, const BakeOptions& options,
                          const Observer& observer, PendingOutputs& outputs) {
  const Output& output = solved.recipe.outputs[index];
  warn_of_skin(solved, observer);
  WrittenOutput written =
      output.still
          ? write_output(solved, output, make_still_output(solved, *output.still, options.solve))
          : write_animated_output(solved, {output, options, observer});
  const bool has_targets = !written.report.targets.empty();
  if (!output.still && !has_targets) warn_of_no_targets(solved.recipe, index, observer);
  if (has_targets) warn_of_targets(solved, index, written.all_targets, observer);
  check_positions(solved.recipe, index, written.report, observer);
  check_normals(solved.recipe, index, written.report.normals, observer);
  return {std::move(written.report), outputs.stage(output.file, written.bytes), written.node};
}

}  // namespace morphbake
