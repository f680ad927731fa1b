#include "morphbake/bake/solve_recipe.h"

#include <optional>
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

/// The regions' fields, of which those that take long are kept one by one.
RegionFields make_regions(const Recipe& recipe, const MorphableMesh& mesh,
                          const std::vector<SourceMesh>& originals, BakeCache& cache,
                          const BakeKeys& keys, const Observer& observer) {
  std::vector<std::optional<RegionField>> known(recipe.regions.size());
  for (std::size_t r = 0; cache.is_on() && r < known.size(); ++r) {
    if (!is_worth_keeping(recipe.regions[r])) continue;
    const std::optional<KeptStage> kept = cache.find(keys.regions[r]);
    if (!kept) continue;
    known[r] = region_of(kept->entry, recipe.regions[r], mesh.connectivity.vertex_count);
    if (known[r]) cache.take(keys.regions[r], kept->warnings, observer);
  }
  std::vector<bool> is_new;
  for (std::size_t r = 0; r < known.size(); ++r) {
    is_new.push_back(!known[r] && is_worth_keeping(recipe.regions[r]));
  }
  const Stopwatch watch;  // of all together: they share a factorisation
  RegionFields fields =
      region_fields(mesh, recipe, mask_values(mesh, recipe, originals), std::move(known));
  for (std::size_t r = 0; cache.is_on() && r < fields.size(); ++r) {
    if (is_new[r]) cache.keep(keys.regions[r], entry_of(fields[r]), {}, watch.seconds());
  }
  return fields;
}

/// Adds the geometries of sources that are made from others.
void add_derived(const Recipe& recipe, const RegionFields& regions, BakeCache& cache,
                 const BakeKeys& keys, const Observer& observer, MorphableMesh& mesh) {
  if (recipe.derived.empty()) return;
  const std::size_t before = mesh.geometries.size();
  std::vector<Positions> geometries = taken_or_made(
      cache, keys.derived, observer,
      [&](const Observer& listening) {
        MorphableMesh derived = mesh;
        derive_sources(recipe, regions, derived, listening);
        return std::vector<Positions>(
            derived.geometries.begin() + static_cast<std::ptrdiff_t>(before),
            derived.geometries.end());
      },
      [](const std::vector<Positions>& made) { return entry_of(made); },
      [&](const CacheEntry& entry) {
        return geometries_of(entry, recipe.derived.size(), mesh.connectivity.vertex_count);
      });
  for (std::size_t i = 0; i < recipe.derived.size(); ++i) {
    mesh.geometries.push_back(std::move(geometries[i]));
    mesh.names.push_back(recipe.derived[i].name);
  }
}

/// The mesh with the shapes of all sources, and the regions on it.
void shape_sources(ConnectedSources connected, BakeCache& cache, const BakeKeys& keys,
                   const Observer& observer, SolvedStages& stages) {
  const bool is_new = !connected.originals.empty();  // masks are read from the files as loaded
  stages.regions =
      make_regions(stages.recipe, stages.mesh, is_new ? connected.originals : connected.sources,
                   cache, keys, observer);
  add_derived(stages.recipe, stages.regions, cache, keys, observer, stages.mesh);
  fit_edits(stages.recipe, stages.mesh, stages.regions);
  stages.sources = std::move(connected.sources);
  stages.connectivity = std::move(connected.report);
}

}  // namespace

std::unique_ptr<SolvedStages> solve_recipe(const Recipe& recipe, const BakeOptions& options,
                                           BakeCache& cache, const BakeKeys& keys,
                                           StageClock& clock, const Observer& caller) {
  auto stages = std::make_unique<SolvedStages>();
  const Observer& observer = stages->observer = recording(caller, stages->warnings);
  clock.start("sources");
  AlignedSources aligned = load_aligned(recipe, observer);
  stages->recipe = std::move(aligned.recipe);
  clock.start("connectivity");
  check_connected_alike(stages->recipe, aligned.sources, mismatch_picture_of(recipe), options,
                        observer);
  ConnectedSources connected = connect_sources(stages->recipe, std::move(aligned.sources),
                                               Measuring::On, cache, keys.connectivity, observer);
  stages->mesh = share_sources(connected.sources, connected.report, observer);
  clock.start("transition");
  shape_sources(std::move(connected), cache, keys, observer, *stages);
  clock.start("solve");
  SolveOptions solving = options.solve;
  solving.orders = cache.entries();
  stages->timeline = solve_timeline(stages->recipe, stages->mesh, stages->regions, solving, cache,
                                    keys.shapes, observer);
  clock.start("export");
  stages->groups = find_smoothing_groups(stages->sources.front(), stages->mesh);
  stages->colours = shape_colours(stages->recipe, stages->sources);
  return stages;
}

void check_recipe(const Recipe& recipe, const BakeOptions& options, const Observer& observer) {
  const StageCache none;
  BakeCache cache(none, recipe, observer);
  SolvedStages stages;
  AlignedSources aligned = load_aligned(recipe, observer);
  stages.recipe = std::move(aligned.recipe);
  ConnectedSources connected = connect_sources(stages.recipe, std::move(aligned.sources),
                                               Measuring::Off, cache, {}, observer);
  stages.mesh = share_sources(connected.sources, connected.report, observer);
  shape_sources(std::move(connected), cache, {}, observer, stages);
  check_timeline(stages.recipe, stages.mesh, stages.regions, options.solve, observer);
}

}  // namespace morphbake
