#pragma once

#include "morphbake/mesh/mesh.h"

namespace morphbake {

/// The largest distance of any point of `from` to `to`, too small by at most `error_bound`.
///
/// @see  CGAL bounded_error_Hausdorff_distance
double hausdorff_distance(const Mesh& from, const Mesh& to, double error_bound);

/// Pairs of triangles that meet elsewhere than at a common vertex or edge; triangles without area
/// count as well.
///
/// @param mesh  an oriented manifold
int count_self_intersections(const Mesh& mesh);

/// Triangles on the unit sphere that the origin does not see counter-clockwise from outside, by an
/// exact predicate.
int count_flipped(const Positions& sphere, const Triangles& triangles);

/// Sum of the signed solid angles that triangles fill, seen from the origin.
double solid_angle(const Positions& sphere, const Triangles& triangles);

}  // namespace morphbake
