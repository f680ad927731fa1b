#pragma once

#include <vector>

#include "morphbake/mesh/mesh.h"

namespace morphbake {

/// Length of the diagonal of the axis-aligned bounding box; 0 for no points.
double bounding_diagonal(const Positions& positions);

/// Triangles that have an area, rising.
std::vector<int> triangles_with_area(const Positions& positions, const Triangles& triangles);

/// A third of the areas of the adjacent triangles, one a vertex.
Eigen::VectorXd vertex_areas(const Positions& positions, const Triangles& triangles);

/// One a triangle.
Eigen::VectorXd triangle_areas(const Positions& positions, const Triangles& triangles);

/// Volume within a closed surface, negative when its triangles face inwards; parts that are wound
/// round twice count twice. Of an open surface it is that of the cone from its first vertex.
double enclosed_volume(const Positions& positions, const Triangles& triangles);

/// The largest distance between equal rows.
double largest_distance(const Positions& a, const Positions& b);

}  // namespace morphbake
