#pragma once

#include <vector>

#include "morphbake/mesh/mesh.h"

namespace morphbake {

/// Which triangles run against the others of their piece, and whether the pieces have two sides.
struct Orientation {
  std::vector<char> is_turned;      ///< one a triangle; none in a piece that has one side only
  std::vector<int> twisted_pieces;  ///< first triangle of each piece with one side, as a Moebius
                                    ///< strip has
};

/// Compares the windings of triangles that meet at an edge.
///
/// A piece is what hangs together over edges of exactly two triangles. Fewer than half of its
/// triangles are turned; where it is half, those that run against the piece's first triangle.
Orientation find_orientation(const Triangles& triangles);

}  // namespace morphbake
