#pragma once

#include <vector>

#include "morphbake/connectivity/layered_triangulation.h"
#include "morphbake/connectivity/patch.h"

namespace morphbake {

/// Where the vertices of all sources lie in the triangulation; kept from pass to pass, since they
/// hardly move.
struct SourcePoints {
  std::vector<std::vector<int>> order;     ///< one a layer: neighbours follow one another
  std::vector<std::vector<int>> triangle;  ///< one a layer, one a source vertex: where it was last
};

SourcePoints source_points(const LayeredTriangulation& t);

/// What a pass found and did.
struct Pass {
  double error = 0;  ///< largest, before the pass, as a fraction of the source's diagonal
  int changes = 0;
};

/// Puts the worst source vertex of each triangle that is further than `tolerance` from a source
/// into the triangulation, exactly where it lies.
///
/// @param tolerance   fraction of the diagonal
/// @param vertex_limit  no vertices beyond
Pass insert_worst_points(LayeredTriangulation& t, SourcePoints& points, double tolerance,
                         int vertex_limit);

/// The same for the boundary curve of disks.
Pass insert_boundary_points(LayeredTriangulation& t, double tolerance, int vertex_limit);

/// Splits edges that are longer than `length` on some source (fraction of its diagonal), the
/// longest first.
Pass split_long_edges(LayeredTriangulation& t, double length, int vertex_limit);

/// Splits edges whose middle is further than `tolerance` from some source.
Pass split_deviating_edges(LayeredTriangulation& t, double tolerance, int vertex_limit);

/// Turns edges towards larger opposite angles and towards the sources' own creases.
Pass flip_edges(LayeredTriangulation& t, double tolerance, const Patch& patch = {});

/// Distance of every source vertex from the triangulation's triangle over it.
///
/// @return  one list a layer, fractions of the diagonal
std::vector<std::vector<double>> source_errors(const LayeredTriangulation& t, SourcePoints& points);

}  // namespace morphbake
