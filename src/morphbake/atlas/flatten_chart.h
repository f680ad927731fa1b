#pragma once

#include <optional>
#include <vector>

#include "morphbake/atlas/atlas.h"
#include "morphbake/mesh/mesh.h"

namespace morphbake {

/// A disk of triangles in the plane, in the units of the surface.
struct FlatChart {
  std::vector<int> triangles;  ///< of the mesh
  std::vector<int> of_corner;  ///< 3 #triangles -> row of `places`
  PicturePlaces places;        ///< y upwards: counter-clockwise as seen from outside
};

/// Lays a disk flat with angles kept as well as possible, its whole area that of the surface.
///
/// @param triangles  a disk of the mesh; a single one is only laid down
/// @return nothing when a triangle is turned over, triangles overlap, the mean length in a triangle
///         is halved or doubled, or that in any one direction on more than 2 % of the area
/// @see Lévy, Petitjean, Ray, Maillot 2002: least squares conformal maps
std::optional<FlatChart> flatten_chart(const Mesh& mesh, const std::vector<int>& triangles);

}  // namespace morphbake
