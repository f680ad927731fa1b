#pragma once

#include "morphbake/connectivity/layered_triangulation.h"
#include "morphbake/connectivity/refine.h"

namespace morphbake {

/// Refines where triangles are folded over, or cut one another although their sources do not there,
/// and repairs again, until there are none or nothing helps any more.
///
/// Both come from chords across detail that is finer than the tolerance: on the sphere, where the
/// triangulation is made, nothing is folded. Nearer to the surfaces they vanish.
/// @param tolerance  fraction of the diagonal, that of the rest of the triangulation
void mend(LayeredTriangulation& t, SourcePoints& points, double tolerance, int vertex_limit);

}  // namespace morphbake
