#pragma once

#include "morphbake/connectivity/layered_triangulation.h"
#include "morphbake/connectivity/patch.h"

namespace morphbake {

/// How vertices are relaxed.
struct RelaxOptions {
  int sweeps = 1;
  /// Weight of a triangle's own shape (equilateral) beside that of the map between sources.
  double shape = 0.1;
  /// Weight of a barrier that keeps triangles large enough on the sphere to move on: the map's
  /// energy lives in space and does not see the sphere's walls, at which vertices would stick for
  /// ever.
  double domain = 0.1;
  /// Vertices where a triangle's normal turns from the vertex's by more than this cosine stay
  /// where they capture a feature; -1: none stays.
  double feature_cosine = -1;
  Patch patch;  ///< what moves
};

/// Moves the vertices on each source so that triangles differ little from the mean of all sources
/// and lie flat on the surfaces.
///
/// The mean is that of the metrics (squared edge lengths), taken once a sweep: the cost is linear
/// in the sources, and they can be relaxed side by side. Pairwise energies cost the square.
void relax(LayeredTriangulation& t, const RelaxOptions& options);

}  // namespace morphbake
