#pragma once

#include <memory>
#include <vector>

#include "morphbake/mesh/mesh.h"

namespace morphbake {

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

/// Distances from many vertices of one connected mesh, which is factorised once.
///
/// By the heat method as geodesic_distances; along edges where triangles are too thin for it.
class VertexDistances {
 public:
  /// @param mesh  in one piece; must outlive this
  explicit VertexDistances(const Mesh& mesh);
  ~VertexDistances();
  VertexDistances(const VertexDistances&) = delete;
  VertexDistances& operator=(const VertexDistances&) = delete;

  /// @return  #V, scene units, 0 or more
  Eigen::VectorXd from(int vertex);

 private:
  struct Heat;
  const Mesh& mesh_;
  std::unique_ptr<Heat> heat_;  ///< none: along edges
};

}  // namespace morphbake
