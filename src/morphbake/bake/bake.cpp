#include "morphbake/bake/bake.h"

#include "morphbake/bake/connect_sources.h"
#include "morphbake/bake/derive_sources.h"
#include "morphbake/bake/load_sources.h"
#include "morphbake/bake/outputs.h"
#include "morphbake/bake/previews.h"
#include "morphbake/bake/region_pictures.h"
#include "morphbake/bake/share_sources.h"
#include "morphbake/bake/stage_clock.h"
#include "morphbake/transition/fit.h"
#include "morphbake/transition/masks.h"
#include "morphbake/transition/regions.h"

namespace morphbake {
namespace {

std::filesystem::path stem_of(std::filesystem::path file) { return file.replace_extension(); }

/// The recipe's regions, and the shapes that are made from its sources with their help.
RegionFields shape_sources(Recipe& recipe, const ConnectedSources& connected, MorphableMesh& mesh,
                           const Observer& observer) {
  const bool is_new = !connected.originals.empty();  // masks are read from the files as loaded
  RegionFields regions = region_fields(
      mesh, recipe, mask_values(mesh, recipe, is_new ? connected.originals : connected.sources));
  derive_sources(recipe, regions, mesh, observer);
  fit_edits(recipe, mesh, regions);
  return regions;
}

std::filesystem::path with_ending(const std::filesystem::path& file, const char* ending) {
  return stem_of(file) += ending;
}

/// Stages the pictures that explain the recipe, beside the first output.
void stage_maps(const SolvedRecipe& solved, const BakeOptions& options, const Observer& observer,
                StagedOutput& first, PendingOutputs& outputs) {
  const auto& [recipe, source, mesh, regions, timeline, groups, colours] = solved;
  for (const MapKind kind : recipe.preview->maps) {
    const bool of_regions = kind == MapKind::Regions;
    const std::filesystem::path file =
        with_ending(recipe.outputs.front().file, of_regions ? ".regions.png" : ".shares.png");
    outputs.stage(file,
                  encode_png(of_regions ? region_sheet(recipe, mesh, regions, options, observer)
                                        : share_sheet(recipe, mesh, regions, timeline, options)));
    first.report.previews.push_back(file);
  }
}

}  // namespace

BakeReport bake(const Recipe& asked, const BakeOptions& options, const Observer& caller) {
  BakeReport bake_report;
  bake_report.recipe = asked.name;
  const Observer observer = recording(caller, bake_report.problems);
  StageClock clock(observer);

  clock.start("sources");
  auto [recipe, loaded] = load_aligned(asked, observer);
  clock.start("connectivity");
  check_connected_alike(recipe, loaded, with_ending(recipe.outputs.front().file, ".mismatch.png"),
                        options, observer);
  ConnectedSources connected = connect_sources(recipe, std::move(loaded), Measuring::On, observer);
  const std::vector<SourceMesh>& sources = connected.sources;
  MorphableMesh mesh = share_sources(sources, connected.report, observer);
  clock.start("transition");
  const RegionFields regions = shape_sources(recipe, connected, mesh, observer);
  clock.start("solve");
  const std::unique_ptr<SolvedTimeline> timeline =
      solve_timeline(recipe, mesh, regions, options.solve, observer);
  clock.start("export");
  const SmoothingGroups groups = find_smoothing_groups(sources.front(), mesh);
  const ShapeColours colours = shape_colours(recipe, sources, mesh);
  PendingOutputs outputs;
  const SolvedRecipe solved{recipe, sources.front(), mesh, regions, *timeline, groups, colours};
  std::vector<StagedOutput> staged;
  for (std::size_t i = 0; i < recipe.outputs.size(); ++i) {
    staged.push_back(stage_output(solved, i, options, observer, outputs));
  }
  if (recipe.preview) {
    clock.start("preview");
    for (auto& [output, file, node] : staged) {
      output.previews = stage_previews({file, output.file, stem_of(output.file), node},
                                       turntable_of(*recipe.preview, options),
                                       recipe.preview->formats, observer, outputs);
    }
  }
  if (recipe.preview) stage_maps(solved, options, observer, staged.front(), outputs);
  outputs.commit();
  for (StagedOutput& each : staged) bake_report.outputs.push_back(std::move(each.report));

  bake_report.vertices = mesh.connectivity.vertex_count;
  bake_report.triangles = static_cast<int>(mesh.connectivity.triangles.rows());
  bake_report.components = timeline->states->displacements->components().count;
  bake_report.frames = static_cast<int>(frame_times(recipe.timeline).size());
  bake_report.connectivity = std::move(connected.report);
  bake_report.connectivity.vertices = bake_report.vertices;
  bake_report.connectivity.triangles = bake_report.triangles;
  bake_report.solve = timeline->report;
  bake_report.stages = clock.finish();
  return bake_report;
}

void validate(const Recipe& asked, const BakeOptions& options, const Observer& observer) {
  auto [recipe, loaded] = load_aligned(asked, observer);
  ConnectedSources connected = connect_sources(recipe, std::move(loaded), Measuring::Off, observer);
  MorphableMesh mesh = share_sources(connected.sources, connected.report, observer);
  const RegionFields regions = shape_sources(recipe, connected, mesh, observer);
  check_timeline(recipe, mesh, regions, options.solve, observer);
}

}  // namespace morphbake
