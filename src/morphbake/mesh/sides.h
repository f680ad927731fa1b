#pragma once

#include <algorithm>
#include <vector>

#include "morphbake/mesh/mesh.h"

namespace morphbake {

/// A side of a triangle, between two different vertices.
struct TriangleSide {
  int low = 0, high = 0;  ///< its vertices, low < high
  bool forward = false;   ///< runs from low to high
  int triangle = 0;
  int corner = 0;  ///< corner of the triangle that it starts at: 0, 1 or 2
};

/// All sides but those that repeat a vertex, sorted so that those of one edge lie together, by
/// triangle.
std::vector<TriangleSide> sorted_sides(const Triangles& triangles);

/// Calls visit(first, last) for each run of sides that are one edge, in the order of its vertices.
template <typename Visit>
void for_each_edge(const std::vector<TriangleSide>& sides, const Visit& visit) {
  for (auto first = sides.begin(); first != sides.end();) {
    const auto last = std::find_if(first, sides.end(), [&](const TriangleSide& side) {
      return side.low != first->low || side.high != first->high;
    });
    visit(first, last);
    first = last;
  }
}

}  // namespace morphbake
