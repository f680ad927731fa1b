#pragma once

#include <vector>

#include "morphbake/mesh/mesh.h"

namespace morphbake {

/// What exact arithmetic says of triangles on the unit sphere.
struct SphereCheck {
  int turned = 0;     ///< triangles that are not counter-clockwise (CGAL's exact orientation)
  double degree = 0;  ///< signed solid angles over those of the (half) sphere: 1 when covered once
};

/// @param sphere     #V by 3
/// @param is_half    whether a hemisphere is to be covered
SphereCheck check_sphere(const Positions& sphere, const Triangles& triangles, bool is_half);

}  // namespace morphbake
