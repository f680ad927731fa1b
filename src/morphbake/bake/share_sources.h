#pragma once

#include <filesystem>
#include <vector>

#include "morphbake/bake/connectivity_report.h"
#include "morphbake/bake/options.h"
#include "morphbake/connectivity/morphable_mesh.h"
#include "morphbake/diagnostics/observer.h"
#include "morphbake/recipe/recipe.h"
#include "morphbake/sources/source_mesh.h"

namespace morphbake {

/// Checks that sources are connected alike, if they are to share their triangles, and draws where
/// they are not: the picture is all that a bake then leaves.
///
/// @param picture  the PNG, written only before the error that names it
/// @throws BakeError as share_connectivity of sources that are not connected alike; Cancelled
void check_connected_alike(const Recipe& recipe, const std::vector<SourceMesh>& sources,
                           const std::filesystem::path& picture, const BakeOptions& options,
                           const Observer& observer);

/// Joins sources as share_connectivity. In the mode "shared" it warns as surface_warnings and notes
/// what was mended; new triangles, of the other modes, are not the user's.
MorphableMesh share_sources(const std::vector<SourceMesh>& sources, ConnectivityReport& report,
                            const Observer& observer);

}  // namespace morphbake
