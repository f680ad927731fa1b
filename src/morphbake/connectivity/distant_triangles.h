#pragma once

#include <vector>

#include "morphbake/connectivity/layered_triangulation.h"
#include "morphbake/connectivity/refine.h"

namespace morphbake {

/// Triangles of a layer that are further than `bound` from its source, or over which the source is
/// that far from all triangles.
///
/// Looks at points that are spread over both surfaces: first at the distance to the place that the
/// sphere gives, which is no smaller than that to the surface; where it is too large, at the
/// distance to the surface.
/// @param points  where the source vertices were last
/// @param bound   fraction of the diagonal
std::vector<int> distant_triangles(const LayeredTriangulation& t, std::size_t layer,
                                   const SourcePoints& points, double bound);

}  // namespace morphbake
