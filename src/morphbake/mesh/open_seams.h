#pragma once

#include <vector>

#include "morphbake/mesh/mesh.h"

namespace morphbake {

/// Edges of the boundary that lie beside another one as closely as if they were meant to be one.
///
/// @param triangles   of a surface that is welded by exact position
/// @param geometries  one or more, each #V by 3: the edges must lie together in all of them, within
///                    1e-6 of the diagonal and a tenth of their length
/// @return            vertices a < b of each, sorted; both edges of a seam
std::vector<Eigen::Vector2i> find_open_seams(const Triangles& triangles,
                                             const std::vector<Positions>& geometries);

}  // namespace morphbake
