#pragma once

#include <array>
#include <vector>

#include "morphbake/diagnostics/observer.h"
#include "morphbake/mesh/mesh.h"

namespace morphbake {

/// How disks of triangles were merged, two and two. Nodes 0 to #F - 1 are the triangles.
struct ChartForest {
  int triangle_count = 0;                  ///< #F
  std::vector<std::array<int, 2>> merged;  ///< node #F + i -> the two nodes it was made of
  std::vector<int> roots;                  ///< what was not merged any further, rising
};

/// Merges triangles to disks that are as flat and round as can be, hard edges on their borders.
///
/// @param mesh        an oriented manifold
/// @param hard_edges  vertices a < b
/// @throws Cancelled
/// @see  Garland, Willmott, Heckbert 2001: hierarchical face clustering; the bend is the area's
/// mean
///       of |n - mean n|^2, L2,1 of Cohen-Steiner et al. 2004
ChartForest merge_charts(const Mesh& mesh, const std::vector<Eigen::Vector2i>& hard_edges,
                         const Observer& observer = {});

/// The triangles of a node, rising.
std::vector<int> triangles_of(const ChartForest& forest, int node);

}  // namespace morphbake
