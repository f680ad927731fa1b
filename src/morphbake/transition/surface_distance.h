#pragma once

#include <vector>

#include "morphbake/mesh/mesh.h"

namespace morphbake {

/// The point of the surface that is closest to `position`.
///
/// @cost  O(#F log #F) for the search tree
SurfacePoint closest_point(const Mesh& mesh, const Eigen::Vector3d& position);

/// Shortest distance along edges (Dijkstra) from a point, whose triangle's corners start at their
/// straight distance to it.
///
/// @return  #V, scene units; infinity where no path leads
/// @see     Alexa 2003, section 5.1
Eigen::VectorXd edge_distances(const Mesh& mesh, const SurfacePoint& centre);

/// Geodesic distance over the surface from each of several points, by the heat method on an
/// intrinsic Delaunay triangulation.
///
/// The centre becomes a vertex of its own (its triangle or edge is split), never the nearest
/// vertex. Error 1-4 % of the distance; it grows where triangles are large against it.
/// @return  one a centre: #V, scene units, 0 or more; infinity on other components
/// @cost    a factorisation a centre
/// @see     Crane, Weischedel and Wardetzky 2013; CGAL Heat_method_3
/// @throws  BakeError "transition.distance-failed"
std::vector<Eigen::VectorXd> geodesic_distances(const Mesh& mesh,
                                                const std::vector<SurfacePoint>& centres);

}  // namespace morphbake
