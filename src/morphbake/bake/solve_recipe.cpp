#include "morphbake/bake/solve_recipe.h"

#include <algorithm>
#include <utility>

#include "morphbake/bake/connect_sources.h"
#include "morphbake/bake/derive_sources.h"
#include "morphbake/bake/kept_stages.h"
#include "morphbake/bake/load_sources.h"
#include "morphbake/bake/share_sources.h"
#include "morphbake/transition/fit.h"
#include "morphbake/transition/masks.h"
#include "morphbake/transition/regions.h"

namespace morphbake {
namespace {

/// The picture of sources that are not connected alike.
std::filesystem::path mismatch_picture_of(const Recipe& recipe) {
  std::filesystem::path file = recipe.outputs.front().file;
  return file.replace_extension() += ".mismatch.png";
}

/// The regions' fields, of which those that take long are kept: all of them together, since the
/// last bits of distances depend on what else is measured beside them.
RegionFields make_regions(const Recipe& recipe, const MorphableMesh& mesh,
                          const std::vector<SourceMesh>& originals, const StageContext& context) {
  const std::vector<Eigen::VectorXd> masks = mask_values(mesh, recipe, originals);
  if (std::ranges::none_of(recipe.regions, is_worth_keeping)) {
    return region_fields(mesh, recipe, masks);
  }
  RegionFields made;  // when they were not in the cache
  KeptRegions kept = taken_or_made(
      context.cache, context.keys.regions, context.observer,
      [&](const Observer&) {
        made = region_fields(mesh, recipe, masks);
        return kept_regions(recipe, made);
      },
      [&](const CacheEntry& entry) {
        return regions_of(entry, recipe, mesh.connectivity.vertex_count);
      });
  return made.empty() ? region_fields(mesh, recipe, masks, std::move(kept.fields))
                      : std::move(made);
}

/// Adds the geometries of sources that are made from others.
void add_derived(const Recipe& recipe, const RegionFields& regions, const StageContext& context,
                 MorphableMesh& mesh) {
  if (recipe.derived.empty()) return;
  const std::size_t before = mesh.geometries.size();
  KeptGeometries made = taken_or_made(
      context.cache, context.keys.derived, context.observer,
      [&](const Observer& listening) {
        MorphableMesh derived = mesh;
        derive_sources(recipe, regions, derived, listening);
        const auto first = derived.geometries.begin() + static_cast<std::ptrdiff_t>(before);
        return KeptGeometries{{first, derived.geometries.end()}};
      },
      [&](const CacheEntry& entry) {
        return geometries_of(entry, recipe.derived.size(), mesh.connectivity.vertex_count);
      });
  for (std::size_t i = 0; i < recipe.derived.size(); ++i) {
    mesh.geometries.push_back(std::move(made.geometries[i]));
    mesh.names.push_back(recipe.derived[i].name);
  }
}

/// The mesh with the shapes of all sources, and the regions on it.
void shape_sources(ConnectedSources connected, const StageContext& context, SolvedStages& stages) {
  const bool is_new = !connected.originals.empty();  // masks are read from the files as loaded
  stages.regions = make_regions(stages.recipe, stages.mesh,
                                is_new ? connected.originals : connected.sources, context);
  add_derived(stages.recipe, stages.regions, context, stages.mesh);
  fit_edits(stages.recipe, stages.mesh, stages.regions);
  stages.sources = std::move(connected.sources);
  stages.connectivity = std::move(connected.report);
}

}  // namespace

std::unique_ptr<SolvedStages> solve_recipe(const Recipe& recipe, const BakeOptions& options,
                                           const StageContext& caller, StageClock& clock) {
  auto stages = std::make_unique<SolvedStages>();
  stages->observer = recording(caller.observer, stages->warnings);
  const Observer& observer = stages->observer;
  const StageContext context{caller.cache, caller.keys, observer};
  clock.start("sources");
  AlignedSources aligned = load_aligned(recipe, observer);
  stages->recipe = std::move(aligned.recipe);
  clock.start("connectivity");
  check_connected_alike(stages->recipe, aligned.sources, mismatch_picture_of(recipe), options,
                        observer);
  ConnectedSources connected =
      connect_sources(stages->recipe, std::move(aligned.sources), Measuring::On, context);
  stages->mesh = share_sources(connected.sources, connected.report, observer);
  clock.start("transition");
  shape_sources(std::move(connected), context, *stages);
  clock.start("solve");
  SolveOptions solving = options.solve;
  solving.orders = context.cache.entries();
  stages->timeline =
      solve_timeline(stages->recipe, stages->mesh, stages->regions, solving, context);
  clock.start("export");
  stages->groups = find_smoothing_groups(stages->sources.front(), stages->mesh);
  stages->colours = shape_colours(stages->recipe, stages->sources);
  return stages;
}

void check_recipe(const Recipe& recipe, const BakeOptions& options, const Observer& observer) {
  const StageCache none;
  BakeCache cache(none, recipe, observer);
  const BakeKeys keys = no_keys(recipe);
  const StageContext context{cache, keys, observer};
  SolvedStages stages;
  AlignedSources aligned = load_aligned(recipe, observer);
  stages.recipe = std::move(aligned.recipe);
  ConnectedSources connected =
      connect_sources(stages.recipe, std::move(aligned.sources), Measuring::Off, context);
  stages.mesh = share_sources(connected.sources, connected.report, observer);
  shape_sources(std::move(connected), context, stages);
  check_timeline(stages.recipe, stages.mesh, stages.regions, options.solve, observer);
}

}  // namespace morphbake
