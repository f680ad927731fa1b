#pragma once

#include "morphbake/connectivity/layered_triangulation.h"
#include "morphbake/connectivity/patch.h"

namespace morphbake {

/// What triangles should be like.
enum class Rest {
  Mean,   ///< the mean of all layers, in squared edge lengths
  First,  ///< the first layer: layers come to it faster, but do not meet it midway
};

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
  Rest rest = Rest::Mean;
  Patch patch = {};  ///< what moves
};

/// Moves the vertices on each source so that triangles differ little from their rest and lie flat
/// on the surfaces.
///
/// The rest is taken once a sweep: the cost is linear in the sources, and they can be relaxed side
/// by side. Pairwise energies cost the square.
void relax(LayeredTriangulation& t, const RelaxOptions& options);

}  // namespace morphbake
