#pragma once

#include <array>
#include <vector>

#include "morphbake/mesh/mesh.h"

namespace morphbake {

/// The edges of a surface, each once, in the order of their vertices.
struct SurfaceEdges {
  std::vector<std::array<int, 2>> ends;  ///< vertices low < high
  /// Third corners of the two triangles that meet there, that which runs from low to high first;
  /// {-1, -1} where no two triangles run along the edge against one another: borders and heaps.
  std::vector<std::array<int, 2>> apexes;
  /// Whether triangles run along every edge as often forwards as backwards, so that the surface has
  /// an inside. False without triangles.
  bool is_closed = false;
};

SurfaceEdges surface_edges(const Triangles& triangles);

/// One an edge, in units of the positions.
Eigen::VectorXd edge_lengths(const Positions& positions, const SurfaceEdges& edges);

/// How far the surface bends at each edge: the angle between the normals of its two triangles in
/// degrees, above -180 and at most 180; 0 is flat, positive bulges outwards. (180 less it is the
/// dihedral angle inside of the surface: changes of the two differ in sign alone.)
///
/// @return  one an edge; NaN at borders, and beside triangles without area
Eigen::VectorXd bend_angles(const Positions& positions, const SurfaceEdges& edges);

}  // namespace morphbake
