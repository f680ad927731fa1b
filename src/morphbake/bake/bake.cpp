#include "morphbake/bake/bake.h"

#include <algorithm>
#include <functional>
#include <optional>
#include <utility>

#include "morphbake/bake/bake_cache.h"
#include "morphbake/bake/kept_stages.h"
#include "morphbake/bake/load_sources.h"
#include "morphbake/bake/outputs.h"
#include "morphbake/bake/plan.h"
#include "morphbake/bake/previews.h"
#include "morphbake/bake/region_pictures.h"
#include "morphbake/bake/solve_recipe.h"
#include "morphbake/bake/stage_clock.h"

namespace morphbake {
namespace {

namespace fs = std::filesystem;

constexpr std::uintmax_t kLargestPicture = std::uintmax_t{1} << 32;

/// A bake that runs.
struct Running {
  const Recipe& recipe;
  const BakeOptions& options;
  BakeCache& cache;
  const BakeKeys& keys;
  StageClock& clock;
  const Observer& observer;
};

fs::path stem_of(fs::path file) { return file.replace_extension(); }

/// Pictures that belong together.
struct Pictures {
  const StageKey& stage;
  fs::path stem;  ///< with which all their names begin
  std::function<std::vector<fs::path>(const Observer&, PendingOutputs&)> make;
};

/// Pictures that were made, and are to be kept once they have their names.
struct NewPictures {
  const StageKey* stage;
  fs::path stem;
  std::vector<fs::path> files;
  std::vector<Problem> warnings;
  double seconds;
};

/// What all outputs of a bake wait in until they appear.
struct Waiting {
  PendingOutputs outputs;
  std::vector<NewPictures> new_pictures;
};

/// Pictures that the cache has.
struct KeptPictures {
  KeptFiles files;
  std::vector<Problem> warnings;
};

std::optional<KeptPictures> find_pictures(const Running& bake, const StageKey& stage) {
  std::optional<KeptStage> kept = bake.cache.find(stage);
  std::optional<KeptFiles> files = kept ? files_of(std::move(kept->entry)) : std::nullopt;
  if (!files) return {};
  return KeptPictures{std::move(*files), std::move(kept->warnings)};
}

/// Stages pictures, as they were kept or made anew.
///
/// @return  their final names
std::vector<fs::path> stage_pictures(const Running& bake, const Pictures& pictures,
                                     const std::optional<KeptPictures>& kept, Waiting& waiting) {
  std::vector<fs::path> staged;
  if (kept) {
    bake.cache.take(pictures.stage, kept->warnings, bake.observer);
    for (std::size_t i = 0; i < kept->files.endings.size(); ++i) {
      staged.emplace_back(pictures.stem.string() + kept->files.endings[i]);
      waiting.outputs.stage(staged.back(), kept->files.bytes[i]);
    }
    return staged;
  }
  const Stopwatch watch;
  std::vector<Problem> warnings;
  staged = pictures.make(recording(bake.observer, warnings), waiting.outputs);
  waiting.new_pictures.push_back(
      {&pictures.stage, pictures.stem, staged, std::move(warnings), watch.seconds()});
  return staged;
}

void keep_pictures(const Running& bake, const std::vector<NewPictures>& all) {
  if (!bake.cache.is_on()) return;
  for (const NewPictures& pictures : all) {
    KeptFiles kept;
    for (const fs::path& file : pictures.files) {
      kept.endings.push_back(file.string().substr(pictures.stem.string().size()));
      kept.bytes.push_back(read_file(file, kLargestPicture));
    }
    bake.cache.keep(*pictures.stage, entry_of(kept), pictures.warnings, pictures.seconds);
  }
}

/// The pictures that explain the recipe, beside the first output.
std::vector<fs::path> stage_maps(const Running& bake, const SolvedStages& stages,
                                 const Observer& observer, PendingOutputs& outputs) {
  std::vector<fs::path> files;
  for (const MapKind kind : bake.recipe.preview->maps) {
    const bool of_regions = kind == MapKind::Regions;
    files.emplace_back(stem_of(bake.recipe.outputs.front().file).string() +
                       (of_regions ? ".regions.png" : ".shares.png"));
    outputs.stage(files.back(),
                  encode_png(of_regions ? region_sheet(stages.recipe, stages.mesh, stages.regions,
                                                       bake.options, observer)
                                        : share_sheet(stages.recipe, stages.mesh, stages.regions,
                                                      *stages.timeline, bake.options)));
  }
  return files;
}

/// An output that the cache has.
struct KeptOutput {
  BakedOutput output;
  std::vector<Problem> warnings;
};

/// What the cache has of what is written.
struct KeptResults {
  std::vector<std::optional<KeptOutput>> outputs;
  std::optional<KeptPictures> maps;
  std::optional<KeptStage> stages;  ///< what is told of all stages before
  bool are_all = false;             ///< then none of these need to run
};

bool has_maps(const Recipe& recipe) { return recipe.preview && !recipe.preview->maps.empty(); }

KeptResults find_results(const Running& bake) {
  KeptResults kept;
  kept.outputs.resize(bake.recipe.outputs.size());
  if (!bake.cache.is_on()) return kept;
  for (std::size_t i = 0; i < kept.outputs.size(); ++i) {
    std::optional<KeptStage> found = bake.cache.find(bake.keys.outputs[i]);
    if (!found) continue;
    auto output = output_of(std::move(found->entry), bake.recipe.outputs[i].file);
    if (output) kept.outputs[i] = {std::move(*output), std::move(found->warnings)};
  }
  kept.stages = bake.cache.find(bake.keys.solve);
  if (has_maps(bake.recipe)) kept.maps = find_pictures(bake, bake.keys.maps);
  kept.are_all = kept.stages && (kept.maps || !has_maps(bake.recipe)) &&
                 std::ranges::all_of(kept.outputs, [](const auto& one) { return one.has_value(); });
  return kept;
}

/// Runs the stages before the outputs, and says what they did.
std::unique_ptr<SolvedStages> run_stages(const Running& bake, BakeReport& report) {
  const Stopwatch watch;
  auto stages =
      solve_recipe(bake.recipe, bake.options, {bake.cache, bake.keys, bake.observer}, bake.clock);
  report.vertices = stages->mesh.connectivity.vertex_count;
  report.triangles = static_cast<int>(stages->mesh.connectivity.triangles.rows());
  report.components = stages->timeline->states->displacements->components().count;
  report.frames = static_cast<int>(frame_times(stages->recipe.timeline).size());
  report.connectivity = std::move(stages->connectivity);
  report.connectivity.vertices = report.vertices;
  report.connectivity.triangles = report.triangles;
  report.solve = stages->timeline->report;
  if (bake.cache.is_on()) {
    double others = 0;  // stages of their own
    for (const StageKey* stage :
         {&bake.keys.connectivity, &bake.keys.regions, &bake.keys.derived}) {
      others += bake.cache.seconds_of(*stage).value_or(0);
    }
    bake.cache.keep(bake.keys.solve, entry_of(report), stages->warnings, watch.seconds() - others);
  }
  return stages;
}

/// @param stages  none where the output is kept
BakedOutput make_output(const Running& bake, std::size_t index, std::optional<KeptOutput> kept,
                        const SolvedStages* stages) {
  if (kept) {
    bake.cache.take(bake.keys.outputs[index], kept->warnings, bake.observer);
    return std::move(kept->output);
  }
  const Stopwatch watch;
  std::vector<Problem> warnings;
  BakedOutput output =
      bake_output(stages->view(), index, bake.options, recording(bake.observer, warnings));
  if (bake.cache.is_on()) {
    bake.cache.keep(bake.keys.outputs[index], entry_of(output), warnings, watch.seconds());
  }
  return output;
}

/// An output whose bytes wait in a temporary file.
struct StagedOutput {
  fs::path temporary;
  int node = 0;
  OutputReport report;
};

/// @param stages  none where the maps are kept
void stage_all_pictures(const Running& bake, const std::optional<KeptPictures>& maps,
                        const SolvedStages* stages, std::vector<StagedOutput>& staged,
                        Waiting& waiting) {
  const PreviewRequest& request = *bake.recipe.preview;
  bake.clock.start("preview");
  for (std::size_t i = 0; i < staged.size(); ++i) {
    auto& [temporary, node, report] = staged[i];
    const PreviewPaths paths{temporary, report.file, stem_of(report.file), node};
    const auto make = [&](const Observer& observer, PendingOutputs& outputs) {
      return stage_previews(paths, turntable_of(request, bake.options), request.formats, observer,
                            outputs);
    };
    report.previews = stage_pictures(bake, {bake.keys.previews[i], paths.stem, make},
                                     find_pictures(bake, bake.keys.previews[i]), waiting);
  }
  if (!has_maps(bake.recipe)) return;
  const auto make = [&](const Observer& observer, PendingOutputs& outputs) {
    return stage_maps(bake, *stages, observer, outputs);
  };
  for (fs::path& file : stage_pictures(bake, {bake.keys.maps, stem_of(staged[0].report.file), make},
                                       maps, waiting)) {
    staged[0].report.previews.push_back(std::move(file));
  }
}

}  // namespace

BakeReport bake(const Recipe& recipe, const BakeOptions& options, const StageCache& stage_cache,
                const Observer& caller) {
  BakeReport report;
  report.recipe = recipe.name;
  const Observer observer = recording(caller, report.problems);
  StageClock clock(observer);
  BakeCache cache(stage_cache, recipe, observer);
  InputFiles files;
  const BakeKeys keys = cache.is_on() ? bake_keys(recipe, options, files) : no_keys(recipe);
  const Running bake{recipe, options, cache, keys, clock, observer};

  KeptResults kept = find_results(bake);
  std::unique_ptr<SolvedStages> stages;
  if (kept.are_all && fill_in(kept.stages->entry, report)) {
    cache.take(keys.solve, kept.stages->warnings, observer);
    clock.start("export");
  } else {
    stages = run_stages(bake, report);
  }
  Waiting waiting;
  std::vector<StagedOutput> staged;
  for (std::size_t i = 0; i < recipe.outputs.size(); ++i) {
    BakedOutput output = make_output(bake, i, std::move(kept.outputs[i]), stages.get());
    fs::path temporary = waiting.outputs.stage(output.report.file, output.glb);
    staged.push_back({std::move(temporary), output.node, std::move(output.report)});
  }
  if (recipe.preview) stage_all_pictures(bake, kept.maps, stages.get(), staged, waiting);
  waiting.outputs.commit();
  keep_pictures(bake, waiting.new_pictures);
  if (cache.is_on()) remember_plan(recipe, keys, cache);

  for (StagedOutput& each : staged) report.outputs.push_back(std::move(each.report));
  report.stages = clock.finish();
  report.cached = cache.taken();
  return report;
}

void validate(const Recipe& recipe, const BakeOptions& options, const Observer& observer) {
  check_recipe(recipe, options, observer);
}

}  // namespace morphbake
