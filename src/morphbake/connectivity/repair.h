#pragma once

#include "morphbake/connectivity/layered_triangulation.h"

namespace morphbake {

/// Triangles, over all layers, whose normal opposes that of the source below their middle.
int count_folds(const LayeredTriangulation& t);

/// Betters triangles whose badness is above `threshold` by turning, collapsing and moving.
///
/// @param tolerance  how far a source may come to lie from what replaces a triangle (fraction of
/// the
///                   diagonal)
/// @return           how many were bad
int repair(LayeredTriangulation& t, double tolerance, double threshold);

}  // namespace morphbake
