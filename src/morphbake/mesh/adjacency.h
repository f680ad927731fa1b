#pragma once

#include <vector>

#include "morphbake/mesh/mesh.h"

namespace morphbake {

/// The one-rings of a connectivity as one compressed list: the neighbours of vertex i are
/// neighbours[offsets[i]] .. neighbours[offsets[i + 1] - 1], rising.
struct OneRings {
  std::vector<int> offsets;     ///< #V + 1
  std::vector<int> neighbours;  ///< 2 #E

  int degree(int vertex) const {
    const auto i = static_cast<std::size_t>(vertex);
    return offsets[i + 1] - offsets[i];
  }
};

OneRings one_rings(const Connectivity& connectivity);

/// Connected components: one label a vertex, numbered by their first vertex.
struct Components {
  std::vector<int> label;  ///< #V
  int count = 0;
};

Components connected_components(const OneRings& rings);

/// What makes a triangle list no oriented manifold; each list holds the first few places.
struct ManifoldDefects {
  std::vector<int> degenerate_triangles;  ///< repeat a vertex
  std::vector<int>
      misoriented_triangles;  ///< run along an edge in the same direction as a neighbour
  std::vector<Eigen::Vector2i> crowded_edges;  ///< shared by more than two triangles
  std::vector<int> pinched_vertices;           ///< whose triangles form more than one fan
  std::vector<int> unused_vertices;

  bool none() const;
};

/// @param limit  places kept of each kind
ManifoldDefects find_manifold_defects(const Connectivity& connectivity, int limit);

}  // namespace morphbake
