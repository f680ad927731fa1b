#pragma once

#include <vector>

#include "morphbake/mesh/mesh.h"

namespace morphbake {

/// The tip of a protrusion: where the mean geodesic distance to the whole surface has a peak.
struct Tip {
  int vertex = 0;         ///< of the sketch
  double prominence = 0;  ///< how far the peak stands above its saddle, in `ShapeSketch::reach`
  double length = 0;      ///< how far it stands above the first saddle to another tip, likewise
  int base = 0;           ///< the vertex there that is nearest: where the protrusion grows
};

/// What is compared of a shape: a coarse copy of its largest piece, its tips and distances from
/// them.
struct ShapeSketch {
  Mesh mesh;                              ///< in one piece, a few thousand vertices, scene space
  int pieces = 1;                         ///< of the shape; the sketch is of the largest
  double reach = 1;                       ///< mean geodesic distance between points, scene units
  Eigen::VectorXd mean_distance;          ///< #V, from each vertex to the surface, in `reach`
  std::vector<Tip> tips;                  ///< the most prominent first
  std::vector<Eigen::VectorXd> from_tip;  ///< one a tip: #V, geodesic distance in `reach`
  std::vector<int> boundary;              ///< vertices of the longest boundary loop, in order
};

/// Sketches a surface.
///
/// @param surface  an oriented manifold
/// @cost  seconds for half a million vertices: decimation, then about 60 distances on the copy
/// @see   Hilaga et al. 2001, Topology matching (mean geodesic distance); Edelsbrunner et al. 2002
///        (persistence: how far a peak stands above the saddle to a higher one)
ShapeSketch sketch_shape(const Mesh& surface);

}  // namespace morphbake
