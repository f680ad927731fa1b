#pragma once

#include "morphbake/landmarks/correspondences.h"

namespace morphbake {

/// Where the vertices of a sketch lie on the surface that it is a coarse copy of.
///
/// Tips go to the outermost point around, points of the rim to the rim, all others to the closest
/// point of the surface.
/// @param kinds  one a vertex
/// @return       one a vertex: scene coordinates on `surface`
Positions places_on_surface(const Mesh& surface, const Side& side, const std::vector<int>& vertices,
                            const std::vector<PairKind>& kinds);

}  // namespace morphbake
