#pragma once

#include <vector>

#include "morphbake/diagnostics/observer.h"
#include "morphbake/recipe/recipe.h"
#include "morphbake/sources/align_sources.h"
#include "morphbake/sources/source_mesh.h"

namespace morphbake {

/// Loads all sources as their files have them, so that the problems of all are told at once.
///
/// @throws BakeError with the problems of all files
std::vector<SourceMesh> load_sources(const Recipe& recipe, const Observer& observer);

/// The sources where the recipe puts them, and the recipe with its places there.
///
/// @throws BakeError as load_sources, with_positions and align_sources
AlignedSources load_aligned(const Recipe& recipe, const Observer& observer);

/// The same observer, which also keeps the warnings for a report.
Observer recording(const Observer& observer, std::vector<Problem>& problems);

}  // namespace morphbake
