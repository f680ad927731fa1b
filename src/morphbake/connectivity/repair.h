#pragma once

#include <vector>

#include "morphbake/connectivity/layered_triangulation.h"
#include "morphbake/connectivity/refine.h"

namespace morphbake {

/// What a repair found and did.
struct Repaired {
  int bad = 0;      ///< triangles worse than the threshold before the last pass
  int changes = 0;  ///< edges turned and collapsed, vertices moved
};

/// Betters triangles that are folded, distorted or thin, by turning and collapsing edges and moving
/// vertices.
///
/// A triangle's cost is the worst over the layers of its shape (1: even), its distortion from the
/// mean of all layers (1: none) and 1000 for a fold. A change must lower the sum of squared costs,
/// and no source point around it may come to lie further than `tolerance` (or than it did) away: so
/// nothing that is mended here has to be refined again.
/// @param points     where the source vertices lie, as insert_worst_points leaves them
/// @param tolerance  fraction of the diagonal
/// @param threshold  triangles of a lower cost are left as they are
/// @param patch      only triangles with a vertex there are bettered
Repaired repair(LayeredTriangulation& t, SourcePoints& points, double tolerance, double threshold,
                const Patch& patch = {});

}  // namespace morphbake
