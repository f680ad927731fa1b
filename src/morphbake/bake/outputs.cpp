#include "morphbake/bake/outputs.h"

#include <fmt/core.h>

#include <algorithm>
#include <memory>

#include "morphbake/gltf/write_morph.h"
#include "morphbake/mesh/measures.h"
#include "morphbake/version.h"

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

void check_normals(const Recipe& recipe, std::size_t index, const NormalReport& normals,
                   const Observer& observer) {
  const Output& output = recipe.outputs[index];
  const NormalBounds& bounds = output.max_normal_error;
  const bool is_whole = normals.maximum <= bounds.maximum.value_or(180);
  const bool is_mostly = normals.percentile_99 <= bounds.percentile_99.value_or(180);
  if (is_whole && is_mostly) return;
  const double bound = is_whole ? *bounds.percentile_99 : *bounds.maximum;
  Problem problem{
      output.unmet_is_error ? Severity::Error : Severity::Warning, "export.normal-error",
      location_in(recipe, fmt::format("/outputs/{}/max_normal_error", index)),
      fmt::format(
          "normals are up to {:.2f} degrees off ({:.2f} for 99 in 100), more than the {:.4g} "
          "that are allowed; worst at vertex {} and {:.4g} s",
          normals.maximum, normals.percentile_99, bound, normals.vertex, normals.time),
      "\"targets\": \"frames\" follows normals closer than \"tracks\"; a larger bound, or "
      "\"unmet\": \"warning\", accepts it"};
  if (output.unmet_is_error) throw BakeError(std::move(problem));
  report(observer, problem);
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
};

MorphWithMotions make_still_output(const SolvedRecipe& solved, const Still& still,
                                   const SolveOptions& options) {
  const Positions positions = still_positions(solved, still, options);
  return {make_still(solved.first, solved.mesh, solved.groups, positions),
          nullptr,
          {{{0.0}, [positions](double) { return positions; }}}};
}

MorphWithMotions make_animated_output(const SolvedRecipe& solved, const Output& output,
                                      const BasisOptions& options, const Observer& observer) {
  const Timeline& timeline = solved.recipe.timeline;
  const SolvedTimeline& of = solved.timeline;
  const bool by_track = output.targets != TargetKind::Frames && of.shapes.base.rows() > 0;
  MorphWithMotions made;
  made.timeline = std::make_unique<ReferenceMotion>(watched(
      by_track ? continuous_motion(of.shapes, *of.separable, timeline) : stepped_motion(of.frames),
      observer));
  for (const Clip& clip : output.clips) made.motions.push_back(motion_of(*made.timeline, clip));
  const MorphBasis basis =
      by_track ? track_basis(of.shapes, *of.separable, timeline, output.clips, options)
               : frame_basis(of.frames, output.clips);
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
    const double distance = std::max(worst.distance, error.distance);
    const double most_normals = std::max(worst.normal_angle_99, error.normal_angle_99);
    if (c == 0 || error.normal_angle > worst.normal_angle) worst = error;
    worst.distance = distance;
    worst.normal_angle_99 = most_normals;
  }
  return worst;
}

}  // namespace

StagedOutput stage_output(const SolvedRecipe& solved, std::size_t index, const BakeOptions& options,
                          const Observer& observer, PendingOutputs& outputs) {
  const Output& output = solved.recipe.outputs[index];
  auto [morph, timeline, motions] =
      output.still ? make_still_output(solved, *output.still, options.solve)
                   : make_animated_output(solved, output, options.basis, observer);
  const int node = morph.node;
  const auto added = static_cast<std::ptrdiff_t>(morph.target_names.size());
  StagedOutput staged;
  OutputReport& report = staged.report;
  const std::size_t clips = added > 0 ? morph.clips.size() : 0;
  for (const MorphClip& clip : morph.clips) {
    report.weight_keys += static_cast<int>(clip.key_times.size());
  }
  warn_of_skin(solved, observer);
  if (!output.still && added == 0) warn_of_no_targets(solved.recipe, index, observer);
  const std::string bytes =
      write_morph_glb(solved.first.file, morph, fmt::format("morphbake {}", version()));
  morph = {};  // all of it is in the bytes: what they say is measured
  staged.file = outputs.stage(output.file, bytes);
  WrittenMesh written = read_written_mesh(bytes, output.file, node, clips);
  const std::vector<std::string>& names = written.mesh.target_names;
  if (added > 0) warn_of_targets(solved, index, names.size(), observer);
  // Without targets nothing moves, and one weight at rest stands for all clips.
  written.clips.resize(motions.size(), written.clips.front());
  const MorphError error = measure_clips(solved, written, motions);

  const double diagonal = bounding_diagonal(motions.front().positions_at(0));
  report.file = output.file;
  report.bytes = bytes.size();
  report.targets.assign(names.end() - added, names.end());
  report.max_error = diagonal > 0 ? error.distance / diagonal : 0;
  report.normals = {error.normal_angle, error.normal_angle_99, error.normal_time,
                    error.normal_vertex};
  check_normals(solved.recipe, index, report.normals, observer);
  return staged;
}

}  // namespace morphbake
