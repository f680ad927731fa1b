#pragma once

#include "morphbake/connectivity/layered_triangulation.h"

namespace morphbake {

/// Lays edges of the triangulation along the hard edges of every source and marks them as hard.
///
/// On its own source each hard edge is met exactly; where those of two sources cross, there is a
/// vertex. On the other sources the new vertices lie where the sphere puts them.
/// @return hard edges of sources that found no room within `vertex_limit`, or between triangles
int trace_hard_edges(LayeredTriangulation& t, int vertex_limit);

}  // namespace morphbake
