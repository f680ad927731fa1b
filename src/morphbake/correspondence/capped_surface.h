#pragma once

#include <vector>

#include "morphbake/mesh/mesh.h"
#include "morphbake/sources/source_surface.h"

namespace morphbake {

/// A source's surface made ready for the sphere: closed, in one piece, its landmarks vertices.
///
/// A disk is closed by one more vertex, the apex, joined to its boundary by cap triangles; the
/// apex's position means nothing. No other edge joins two boundary vertices, for its image would
/// lie on the equator as they do.
struct CappedSurface {
  Positions positions;  ///< #V by 3, scene space; the apex last
  Triangles triangles;  ///< cap triangles last
  int apex = -1;        ///< vertex, -1 for a closed surface
  int cap_triangles = 0;
  std::vector<SurfacePoint> on_source;  ///< #V (the apex: nowhere)
  std::vector<int> source_triangle;     ///< #F without cap triangles
  std::vector<char> on_boundary;        ///< #V
  std::vector<int> landmarks;
  std::vector<Eigen::Vector2i> hard_edges;  ///< a < b
};

/// @param source  one in which topology_problems finds nothing
CappedSurface cap_surface(const SourceSurface& source);

}  // namespace morphbake
