#include "morphbake/bake/outputs.h"

#include <fmt/core.h>

#include "morphbake/gltf/write_morph.h"
#include "morphbake/mesh/measures.h"
#include "morphbake/version.h"

namespace morphbake {
namespace {

// What three.js and Babylon.js read at most.
constexpr std::size_t kEngineTargetLimit = 255;

Positions still_positions(const SolvedRecipe& solved, const Still& still) {
  const Recipe& recipe = solved.recipe;
  if (const double* time = std::get_if<double>(&still.at)) {
    return combine_shapes(solved.shapes,
                          field_coefficients(recipe.timeline, solved.separable, *time));
  }
  const State& state = recipe.states[static_cast<std::size_t>(std::get<int>(still.at))];
  const auto vertex_count = static_cast<Eigen::Index>(solved.mesh.connectivity.vertex_count);
  return solved.system.solve_or_blend(state_transition(state, solved.regions, vertex_count),
                                      solved.gauge);
}

void warn_of_many_targets(const Recipe& recipe, std::size_t index, std::size_t count,
                          const Observer& observer) {
  if (count <= kEngineTargetLimit) return;
  report(observer, Problem{Severity::Warning,
                           "export.many-targets",
                           {recipe.file.string(), fmt::format("/outputs/{}/targets", index), 0, 0},
                           fmt::format("{} morph targets; three.js and Babylon.js read at most {}",
                                       count, kEngineTargetLimit),
                           "use \"targets\": \"tracks\", a lower fps or a shorter timeline"});
}

/// A morph and the motion that it is to show.
struct MorphWithMotion {
  MeshMorph morph;
  ReferenceMotion motion;
};

MorphWithMotion make_still_output(const SolvedRecipe& solved, const Still& still) {
  const Positions positions = still_positions(solved, still);
  return {make_still(solved.first, solved.mesh, solved.groups, positions),
          {{0.0}, [positions](double) { return positions; }}};
}

MorphWithMotion make_animated_output(const SolvedRecipe& solved, TargetKind targets,
                                     const BasisOptions& options) {
  const Timeline& timeline = solved.recipe.timeline;
  const ReferenceMotion motion =
      reference_motion(solved.shapes, solved.separable, timeline, targets);
  const MorphBasis basis = targets == TargetKind::Tracks
                               ? track_basis(solved.shapes, solved.separable, timeline, options)
                               : frame_basis(solved.shapes, solved.separable, timeline);
  MeshMorph morph = make_mesh_morph(solved.first, solved.mesh, basis, solved.groups, motion);
  morph.animation_name = solved.recipe.name;
  return {std::move(morph), motion};
}

}  // namespace

OutputReport stage_output(const SolvedRecipe& solved, std::size_t index, const BakeOptions& options,
                          const Observer& observer, PendingOutputs& outputs,
                          std::filesystem::path& staged) {
  const Output& output = solved.recipe.outputs[index];
  const auto [morph, motion] = output.still
                                   ? make_still_output(solved, *output.still)
                                   : make_animated_output(solved, output.targets, options.basis);
  warn_of_many_targets(solved.recipe, index, morph.target_names.size(), observer);
  const MorphError error =
      measure_mesh_morph(solved.first, solved.mesh, morph, solved.groups, motion);
  const std::string bytes =
      write_morph_glb(solved.first.file, morph, fmt::format("morphbake {}", version()));
  staged = outputs.stage(output.file, bytes);

  const double diagonal = bounding_diagonal(motion.positions_at(0));
  OutputReport report;
  report.file = output.file;
  report.bytes = bytes.size();
  report.targets = morph.target_names;
  report.weight_keys = static_cast<int>(morph.key_times.size());
  report.max_error = diagonal > 0 ? error.distance / diagonal : 0;
  report.max_normal_error = error.normal_angle;
  return report;
}

}  // namespace morphbake
