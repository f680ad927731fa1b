#include "morphbake/bake/outputs.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <utility>

#include "morphbake/bake/encode_output.h"
#include "morphbake/bake/output_bounds.h"
#include "morphbake/bake/output_morph.h"
#include "morphbake/lint/lint.h"
#include "morphbake/mesh/measures.h"

namespace morphbake {
namespace {

// What three.js and Babylon.js read at most.
constexpr std::size_t kEngineTargetLimit = 255;

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
                           "\"targets\": \"keyframes\" or \"basis\" needs fewer"});
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

/// A tolerance whose targets do not keep an output's bounds.
struct FailingTolerance {
  double tolerance = 0;
  std::size_t targets = 0;
};

/// A tolerance whose targets do, and what they give.
struct KeepingTolerance {
  double tolerance = 0;
  WrittenOutput written;
};

/// Fewer targets that keep the bounds, between two tolerances.
///
/// @param write  an output whose targets are chosen for a tolerance
WrittenOutput fewest_targets(const Output& output, FailingTolerance failing,
                             KeepingTolerance keeping,
                             const std::function<WrittenOutput(double tolerance)>& write) {
  constexpr int kHalvings = 3;
  for (int i = 0; i < kHalvings && failing.targets + 1 < keeping.written.all_targets; ++i) {
    const double middle = std::sqrt(failing.tolerance * keeping.tolerance);
    WrittenOutput tried = write(middle);
    if (keeps_bounds(output, tried.report)) {
      keeping = {middle, std::move(tried)};
    } else {
      failing = {middle, tried.all_targets};
    }
  }
  return std::move(keeping.written);
}

/// How many targets the profile's client reads of a mesh; none: no limit is known.
std::optional<int> target_limit(const SolvedRecipe& solved, const Output& output) {
  if (!output.profile) return {};
  return most_targets(*output.profile, solved.groups.count > 0);
}

/// The output with as few targets as keep its bounds; where they are not to be kept, with as many
/// as frames give or the tolerance reaches.
WrittenOutput write_fewest(const SolvedRecipe& solved, const OutputInputs& inputs) {
  constexpr double kTighter = 0.6;
  constexpr int kMostTightenings = 20;  // 4e-5 of the bound
  const Output& output = inputs.output;
  const std::size_t frames = solved.timeline.frames.times.size();
  const auto write = [&](double tolerance) {
    return write_output(solved, output, make_animated_output(solved, inputs, tolerance));
  };
  double tolerance = output.max_error * bounding_diagonal(solved.timeline.frames.positions(0));
  WrittenOutput written = write(tolerance);
  for (int i = 0; i < kMostTightenings && !keeps_bounds(output, written.report); ++i) {
    if (written.report.targets.size() + 1 >= frames) break;
    const FailingTolerance failing{tolerance, written.all_targets};
    tolerance *= kTighter;
    written = write(tolerance);
    if (!keeps_bounds(output, written.report)) continue;
    return fewest_targets(output, failing, {tolerance, std::move(written)}, write);
  }
  return written;
}

/// `auto` takes tracks unless the profile's client reads fewer.
WrittenOutput write_animated_output(const SolvedRecipe& solved, OutputInputs inputs) {
  const bool is_exact = inputs.kind == TargetKind::Tracks || inputs.kind == TargetKind::Frames;
  if (!is_exact) return write_fewest(solved, inputs);
  WrittenOutput written =
      write_output(solved, inputs.output, make_animated_output(solved, inputs, 0));
  const std::optional<int> limit = target_limit(solved, inputs.output);
  const bool fits = !limit || written.all_targets <= static_cast<std::size_t>(*limit);
  if (fits || inputs.output.targets != TargetKind::Auto) return written;
  inputs.kind = TargetKind::Auto;
  return write_fewest(solved, inputs);
}

/// What would fit a client that reads so many targets.
std::string fitting_option(const SolvedRecipe& solved, const OutputInputs& inputs,
                           std::size_t most) {
  constexpr double kLooser = 1.3;
  constexpr int kMostLoosenings = 20;  // 190 times the bound
  double max_error = inputs.output.max_error;
  const double diagonal = bounding_diagonal(solved.timeline.frames.positions(0));
  for (int i = 0; i < kMostLoosenings; ++i, max_error *= kLooser) {
    const MorphBasis basis = smallest_basis(solved.timeline.frames, max_error * diagonal,
                                            inputs.output.clips, inputs.observer);
    if (basis.targets.size() > most) continue;
    const std::string kind = name_of(basis.kind);
    return fmt::format("\"targets\": \"{}\" with \"max_error\": {:.2g} needs {}", kind, max_error,
                       basis.targets.size());
  }
  return "choose a shorter timeline, or a profile of another client";
}

/// Looks at what was written as `morphbake lint` does.
///
/// @throws BakeError "export.breaks-profile"
void check_profile(const SolvedRecipe& solved, std::size_t index, const OutputInputs& inputs,
                   const WrittenOutput& written) {
  const Output& output = inputs.output;
  if (!output.profile) return;
  const Profile& profile = *output.profile;
  const LintReport report = lint(open_gltf_bytes(written.bytes, output.file), profile,
                                 {.node = written.node}, {}, inputs.observer);
  const std::optional<int> limit = target_limit(solved, output);
  std::vector<Problem> problems;
  for (const Finding& finding : report.findings) {
    if (finding.severity != FindingSeverity::Error) continue;
    const std::size_t added = written.report.targets.size();
    const std::size_t own = written.all_targets - added;
    const bool is_of_count = finding.rule == std::string("too-many-targets") && limit &&
                             static_cast<std::size_t>(*limit) > own;
    problems.push_back(
        {Severity::Error, "export.breaks-profile",
         location_in(solved.recipe, fmt::format("/outputs/{}/profile", index)),
         fmt::format("{} does not read {}: {} at {}", profile.title,
                     output.file.filename().string(), finding.message, finding.pointer),
         is_of_count ? fitting_option(solved, inputs, static_cast<std::size_t>(*limit) - own)
                     : finding.right});
  }
  if (!problems.empty()) throw BakeError(std::move(problems));
}

}  // namespace

BakedOutput bake_output(const SolvedRecipe& solved, std::size_t index, const BakeOptions& options,
                        const Observer& observer) {
  const Output& output = solved.recipe.outputs[index];
  warn_of_skin(solved, observer);
  const OutputInputs inputs{output, kind_of(output, solved.timeline), options, observer};
  WrittenOutput written =
      output.still
          ? write_output(solved, output, make_still_output(solved, *output.still, options.solve))
          : write_animated_output(solved, inputs);
  const bool has_targets = !written.report.targets.empty();
  if (!output.still && !has_targets) warn_of_no_targets(solved.recipe, index, observer);
  if (has_targets && !output.profile) warn_of_targets(solved, index, written.all_targets, observer);
  check_profile(solved, index, inputs, written);
  check_bounds(solved.recipe, index, written.report, observer);
  return {std::move(written.report), std::move(written.bytes), written.node};
}

}  // namespace morphbake
