#pragma once

#include <vector>

#include "morphbake/diagnostics/observer.h"
#include "morphbake/recipe/recipe.h"
#include "morphbake/sources/source_mesh.h"

namespace morphbake {

/// Loads all sources, so that the problems of all are told at once.
///
/// @throws BakeError with the problems of all files
std::vector<SourceMesh> load_sources(const Recipe& recipe, const Observer& observer);

/// The same observer, which also keeps the warnings for a report.
Observer recording(const Observer& observer, std::vector<Problem>& problems);

}  // namespace morphbake
