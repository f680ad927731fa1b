#pragma once

#include <vector>

#include "morphbake/diagnostics/problem.h"
#include "morphbake/sources/source_surface.h"

namespace morphbake {

/// All that keeps one surface from being laid on a sphere.
///
/// @return  "correspondence.pieces", "correspondence.holes", "correspondence.handles",
///          "correspondence.too-few-vertices"
std::vector<Problem> topology_problems(const SourceSurface& source);

/// The same of several, and "correspondence.different-topology" where the sound ones differ.
///
/// @param sources  those without triangles are passed over
std::vector<Problem> topology_problems(const std::vector<SourceSurface>& sources);

}  // namespace morphbake
