#pragma once

#include <vector>

#include "morphbake/diagnostics/observer.h"
#include "morphbake/recipe/recipe.h"
#include "morphbake/sources/source_mesh.h"
#include "morphbake/sources/source_surface.h"

namespace morphbake {

/// The surfaces of sources of any triangles, with the landmarks that all have.
///
/// @throws BakeError as source_surface, common_landmark_problems and topology_problems, all that is
///         wrong with all sources at once; "connectivity.too-many-vertices" when the landmarks
///         alone are more than max_vertices
std::vector<SourceSurface> own_surfaces(const Recipe& recipe,
                                        const std::vector<SourceMesh>& sources,
                                        const Observer& observer);

/// The surfaces of sources that share their connectivity, with equal triangles.
///
/// @throws BakeError as share_connectivity and landmark_points
std::vector<SourceSurface> shared_surfaces(const Recipe& recipe,
                                           const std::vector<SourceMesh>& sources,
                                           const Observer& observer);

/// Triangle of the source's file, counted over its primitives, of each triangle of its surface.
///
/// @param surface  whose triangles are in the file's order
std::vector<int> triangles_in_file(const SourceSurface& surface, const SourceMesh& source);

}  // namespace morphbake
