#pragma once

#include "morphbake/connectivity/layered_triangulation.h"
#include "morphbake/connectivity/refine.h"

namespace morphbake {

/// Refines where triangles are folded over or degenerate, cut one another although their sources do
/// not there, or are further than `max_error` from a source, and repairs again, until there are
/// none or nothing helps any more.
///
/// Both come from chords across detail that is finer than the tolerance: on the sphere, where the
/// triangulation is made, nothing is folded. Nearer to the surfaces they vanish.
/// @param max_error  fraction of the diagonal
void mend(LayeredTriangulation& t, SourcePoints& points, double max_error, int vertex_limit);

}  // namespace morphbake
