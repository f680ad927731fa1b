#pragma once

#include <Eigen/Core>
#include <vector>

#include "morphbake/differential/deformation.h"
#include "morphbake/mesh/adjacency.h"

namespace morphbake {

/// From a vertex whose rotation is known along an edge to one whose rotation is not.
struct TreeStep {
  int from = 0, to = 0;
  int edge = 0;
};

/// A tree of edges from each start to all vertices that are nearest to it; paths are short.
///
/// @param starts  vertices
std::vector<TreeStep> tree_from(const OneRings& rings, const std::vector<Edge>& edges,
                                const std::vector<int>& starts);

/// The vertex of each component whose rotations, unrolled, are nearest to their mean: a component
/// is turned as a whole as its midst is, not as a detail.
///
/// @param weights  #V: how much each vertex counts; those without any are not chosen, if one has
/// @return  one a component
std::vector<int> middle_vertices(const OneRings& rings, const Components& components,
                                 const std::vector<Edge>& edges,
                                 const std::vector<Deformation>& deformations,
                                 const Eigen::VectorXd& weights);

}  // namespace morphbake
