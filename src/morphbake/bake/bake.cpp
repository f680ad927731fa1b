#include "morphbake/bake/bake.h"

#include "morphbake/bake/outputs.h"
#include "morphbake/bake/places.h"
#include "morphbake/bake/previews.h"
#include "morphbake/bake/stage_clock.h"
#include "morphbake/transition/regions.h"

namespace morphbake {
namespace {

/// Loads all sources, so that the problems of all are told at once.
std::vector<SourceMesh> load_sources(const Recipe& recipe, const Observer& observer) {
  std::vector<SourceMesh> sources;
  std::vector<Problem> problems;
  const auto count = static_cast<int>(recipe.sources.size());
  for (int s = 0; s < count; ++s) {
    advance(observer, {"sources", s, count});
    try {
      sources.push_back(load_source(recipe.sources[static_cast<std::size_t>(s)]));
    } catch (const BakeError& error) {
      problems.insert(problems.end(), error.problems().begin(), error.problems().end());
    }
  }
  if (!problems.empty()) throw BakeError(problems);
  return sources;
}

std::filesystem::path stem_of(std::filesystem::path file) { return file.replace_extension(); }

/// Lets the report keep the warnings that the caller hears.
Observer recording(const Observer& observer, std::vector<Problem>& problems) {
  Observer both = observer;
  both.on_problem = [&observer, &problems](const Problem& problem) {
    problems.push_back(problem);
    report(observer, problem);
  };
  return both;
}

}  // namespace

BakeReport bake(const Recipe& asked, const BakeOptions& options, const Observer& caller) {
  BakeReport bake_report;
  bake_report.recipe = asked.name;
  const Observer observer = recording(caller, bake_report.problems);
  StageClock clock(observer);

  clock.start("sources");
  const std::vector<SourceMesh> sources = load_sources(asked, observer);
  const Recipe recipe = with_positions(asked, sources);
  clock.start("connectivity");
  const MorphableMesh mesh = share_connectivity(sources);
  clock.start("transition");
  const std::vector<Eigen::VectorXd> regions = region_distances(mesh, recipe);
  clock.start("solve");
  const std::unique_ptr<SolvedTimeline> timeline =
      solve_timeline(recipe, mesh, regions, options.solve, observer);
  clock.start("export");
  const SmoothingGroups groups = find_smoothing_groups(sources.front(), mesh);
  PendingOutputs outputs;
  const SolvedRecipe solved{recipe, sources.front(), mesh, regions, *timeline, groups};
  std::vector<StagedOutput> staged;
  for (std::size_t i = 0; i < recipe.outputs.size(); ++i) {
    staged.push_back(stage_output(solved, i, options, observer, outputs));
  }
  if (recipe.preview) {
    clock.start("preview");
    for (auto& [output, file] : staged) {
      output.previews = stage_previews({file, output.file, stem_of(output.file)},
                                       turntable_of(*recipe.preview, options),
                                       recipe.preview->formats, observer, outputs);
    }
  }
  outputs.commit();
  for (StagedOutput& each : staged) bake_report.outputs.push_back(std::move(each.report));

  bake_report.vertices = mesh.connectivity.vertex_count;
  bake_report.triangles = static_cast<int>(mesh.connectivity.triangles.rows());
  bake_report.components = timeline->system->components().count;
  bake_report.frames = static_cast<int>(frame_times(recipe.timeline).size());
  bake_report.solve = timeline->report;
  bake_report.stages = clock.finish();
  return bake_report;
}

void validate(const Recipe& asked, const BakeOptions& options, const Observer& observer) {
  const std::vector<SourceMesh> sources = load_sources(asked, observer);
  const Recipe recipe = with_positions(asked, sources);
  const MorphableMesh mesh = share_connectivity(sources);
  check_timeline(recipe, mesh, region_distances(mesh, recipe), options.solve);
}

}  // namespace morphbake
