#pragma once

#include <optional>
#include <string>
#include <vector>

#include "morphbake/bake/bake_cache.h"
#include "morphbake/bake/connectivity_files.h"
#include "morphbake/bake/connectivity_report.h"
#include "morphbake/bake/stage_clock.h"
#include "morphbake/diagnostics/observer.h"
#include "morphbake/recipe/recipe.h"
#include "morphbake/sources/source_mesh.h"

namespace morphbake {

/// The sources' surfaces with one new triangulation.
struct RemeshedSources {
  std::vector<SourceSurface> surfaces;
  SharedTriangulation triangulation;
  std::optional<BakedTexture> texture;  ///< when the recipe asks for one
  ConnectivityFiles files;
};

/// Makes the new connectivity that the recipe asks for.
///
/// @param recipe  of a mode other than Shared
/// @throws BakeError "connectivity....", "correspondence...."; "gltf...." as surface_colours;
///         Cancelled
RemeshedSources remesh_sources(const Recipe& recipe, const std::vector<SourceMesh>& sources,
                               StageClock& clock, const Observer& observer);

/// What was mended on each source.
std::vector<SourceRepairs> repairs_of(const RemeshedSources& remeshed);

/// What the texture is like, when there is one.
std::optional<TextureReport> texture_report(const RemeshedSources& remeshed);

/// Measures a new connectivity and tells what is worth a look as warnings.
TriangulationQuality measured(const Recipe& recipe, const RemeshedSources& remeshed,
                              const Observer& observer);

/// Whether quality is measured: baking does, checking a recipe does not.
enum class Measuring { On, Off };

/// Sources that share one connectivity: those of the recipe, or the same on a new one.
struct ConnectedSources {
  std::vector<SourceMesh> sources;
  std::vector<SourceMesh> originals;  ///< as loaded, where `sources` are not
  ConnectivityReport report;
};

/// New sources are read from the very bytes that `morphbake remesh` writes, so a bake gives the
/// same from those files. What the cache has is not made again.
///
/// @throws BakeError as remesh_sources
ConnectedSources connect_sources(const Recipe& recipe, std::vector<SourceMesh> sources,
                                 Measuring measuring, const StageContext& context);

}  // namespace morphbake
