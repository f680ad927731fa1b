#pragma once

#include <vector>

#include "morphbake/connectivity/layered_triangulation.h"

namespace morphbake {

/// A triangle on one source, as its cost sees it.
struct LayerTriangle {
  Eigen::Vector3d squared_lengths;  ///< edge k opposite corner k
  double twice_area = 0;
  double cosine = 1;  ///< between its normal and the source's below its middle
};

LayerTriangle layer_triangle(const Layer& layer, int a, int b, int c);

/// How bad a triangle is: the worst over the layers of shape + distortion from the mean of the
/// layers + turn from the source; 2 at best.
///
/// @param folds  receives on how many layers it is folded over
double triangle_cost(const std::vector<LayerTriangle>& layers, int& folds);

/// The same, measured now; 0 of caps.
double triangle_cost(const LayeredTriangulation& t, int f, int& folds);

}  // namespace morphbake
