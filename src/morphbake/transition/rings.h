#pragma once

#include <vector>

#include "morphbake/diagnostics/problem.h"
#include "morphbake/transition/surface_distance.h"

namespace morphbake {

/// Two closed loops of edges, and where their sides are.
struct Rings {
  std::vector<int> inner;        ///< vertices of the inner loop, in order
  std::vector<int> outer;        ///< of the outer one
  std::vector<bool> is_inside;   ///< #V: on the inner loop, or cut off by it from the outer one
  std::vector<bool> is_outside;  ///< #V: on the outer loop, cut off by it, or on another component
};

/// Joins the points of each loop by paths along edges and finds what lies inside the inner and
/// outside the outer one.
///
/// Paths keep to the geodesics, or without these are the shortest along edges, which on a regular
/// mesh may lie far from them.
/// @param inner, outer  three or more points each, in order
/// @param geodesics     of this mesh, or none
/// @param where         of the region, for messages
/// @throws BakeError "transition.distance-failed"; "recipe.ring": a loop that meets itself or the
///         other, whose points cannot be joined, or that does not cut anything off
/// @see    Alexa 2003, section 5.1
Rings find_rings(const Mesh& mesh, const PointSet& inner, const PointSet& outer,
                 GeodesicDistances* geodesics, const Location& where);

/// d = d_in / (d_in + d_out) between the rings.
///
/// @param from_inner, from_outer  #V: distances from the loops
Eigen::VectorXd ring_distance(const Rings& rings, const Eigen::VectorXd& from_inner,
                              const Eigen::VectorXd& from_outer);

/// When a flood reaches each vertex, as a share of its way.
///
/// @param distances  #V, finite
/// @param softness   0: by rank, evenly by number, ties by the place in space; else by distance
/// @see    Alexa 2003, section 5.3
Eigen::VectorXd flood_order(const Eigen::VectorXd& distances, const Positions& positions,
                            double softness);

}  // namespace morphbake
