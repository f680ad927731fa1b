#include "morphbake/bake/connect_sources.h"

#include <utility>

#include "morphbake/bake/kept_stages.h"
#include "morphbake/bake/source_surfaces.h"
#include "morphbake/bake/stage_clock.h"
#include "morphbake/connectivity/measure_triangulation.h"

namespace morphbake {
namespace {

RemeshOptions options_of(const ConnectivityRequest& request) {
  RemeshOptions options;
  options.max_error = request.max_error;
  options.max_vertices = request.max_vertices;
  options.target_edge_length = request.target_edge_length;
  options.sizing = request.sizing == VertexSizing::Uniform ? Sizing::Uniform : Sizing::Curvature;
  return options;
}

SharedTriangulation new_triangulation(const Recipe& recipe,
                                      const std::vector<SourceSurface>& surfaces, StageClock& clock,
                                      const Observer& observer) {
  const RemeshOptions options = options_of(recipe.connectivity);
  if (recipe.connectivity.mode == ConnectivityMode::Resample) {
    clock.start("resample");
    return resample(surfaces, options, observer);
  }
  clock.start("sphere");
  const std::vector<SphericalMap> maps = map_to_sphere(surfaces, observer);
  clock.start("triangulate");
  return triangulate(maps, options, observer);
}

}  // namespace

RemeshedSources remesh_sources(const Recipe& recipe, const std::vector<SourceMesh>& sources,
                               StageClock& clock, const Observer& observer) {
  RemeshedSources remeshed;
  clock.start("surfaces");
  const bool is_shared = recipe.connectivity.mode == ConnectivityMode::Resample;
  remeshed.surfaces = is_shared ? shared_surfaces(recipe, sources, observer)
                                : own_surfaces(recipe, sources, observer);
  std::optional<SurfaceColours> colours;  // now: what is wrong with them is told before the work
  if (recipe.connectivity.texture) {
    colours = texture_colours(recipe, sources, remeshed.surfaces, observer);
  }
  remeshed.triangulation = new_triangulation(recipe, remeshed.surfaces, clock, observer);
  if (colours) {
    clock.start("texture");
    const auto of = static_cast<std::size_t>(recipe.connectivity.texture->of);
    remeshed.texture =
        bake_texture(recipe, remeshed.surfaces[of], *colours, remeshed.triangulation, observer);
  }
  clock.start("carry");
  remeshed.files = write_connectivity_files(sources, remeshed.surfaces, remeshed.triangulation,
                                            remeshed.texture, observer);
  return remeshed;
}

std::vector<SourceRepairs> repairs_of(const RemeshedSources& remeshed) {
  std::vector<SourceRepairs> repairs;
  for (const SourceSurface& surface : remeshed.surfaces) {
    repairs.push_back({surface.name, surface.repairs});
  }
  return repairs;
}

std::optional<TextureReport> texture_report(const RemeshedSources& remeshed) {
  if (!remeshed.texture) return {};
  const Atlas& atlas = remeshed.texture->atlas;
  return TextureReport{atlas.size, atlas.chart_count, atlas.covered};
}

TriangulationQuality measured(const Recipe& recipe, const RemeshedSources& remeshed,
                              const Observer& observer) {
  TriangulationQuality quality =
      measure_triangulation(remeshed.surfaces, remeshed.triangulation, observer);
  for (const Problem& warning : connectivity_warnings(recipe, remeshed.triangulation, quality)) {
    report(observer, warning);
  }
  return quality;
}

namespace {

/// The sources' files on a new connectivity, and what is said of it.
KeptConnectivity new_connectivity(const Recipe& recipe, const std::vector<SourceMesh>& sources,
                                  Measuring measuring, const Observer& observer) {
  StageClock clock(observer);
  RemeshedSources remeshed = remesh_sources(recipe, sources, clock, observer);
  KeptConnectivity connectivity;
  connectivity.report.mode = recipe.connectivity.mode;
  connectivity.report.repairs = repairs_of(remeshed);
  connectivity.report.texture = texture_report(remeshed);
  if (measuring == Measuring::On) {
    clock.start("measure");
    connectivity.report.quality = measured(recipe, remeshed, observer);
  }
  connectivity.report.steps = clock.finish();
  connectivity.glbs = std::move(remeshed.files.glbs);
  return connectivity;
}

}  // namespace

ConnectedSources connect_sources(const Recipe& recipe, std::vector<SourceMesh> sources,
                                 Measuring measuring, const StageContext& context) {
  ConnectedSources connected;
  connected.report.mode = recipe.connectivity.mode;
  if (recipe.connectivity.mode == ConnectivityMode::Shared) {
    connected.sources = std::move(sources);
    return connected;
  }
  KeptConnectivity made = taken_or_made(
      context.cache, context.keys.connectivity, context.observer,
      [&](const Observer& listening) {
        return new_connectivity(recipe, sources, measuring, listening);
      },
      [&](CacheEntry entry) { return connectivity_of(std::move(entry), sources.size()); });
  for (std::size_t s = 0; s < sources.size(); ++s) {
    connected.sources.push_back(read_source(
        sources[s].name, open_gltf_bytes(std::move(made.glbs[s]), recipe.sources[s].file)));
  }
  connected.originals = std::move(sources);
  connected.report = std::move(made.report);
  return connected;
}

}  // namespace morphbake
