#pragma once

#include <memory>
#include <vector>

#include "morphbake/diagnostics/problem.h"
#include "morphbake/mesh/mesh.h"

namespace morphbake {

/// Points of a surface from which distances are measured together: the nearest one counts.
using PointSet = std::vector<SurfacePoint>;

/// Shortest distance along edges (Dijkstra) from the nearest of several points, whose triangle's
/// corners start at their straight distance to it.
///
/// @return  #V, scene units; infinity where no path leads
/// @see     Alexa 2003, section 5.1
Eigen::VectorXd edge_distances(const Mesh& mesh, const PointSet& from);

/// Fewest edges to walk from the nearest of several vertices.
///
/// @return  #V; infinity where no path leads
Eigen::VectorXd hop_distances(const Mesh& mesh, const std::vector<int>& from);

/// Geodesic distance over the surface from each of several sets of points, by the heat method on an
/// intrinsic Delaunay triangulation.
///
/// A point becomes a vertex of its own (its triangle or edge is split), never the nearest vertex.
/// Error 1-4 % of the distance; it grows where triangles are large against it.
/// @param sets   none is empty
/// @param where  the place that a failure is told at
/// @return  one a set: #V, scene units, 0 or more; infinity on components without a point of it
/// @cost    one factorisation a component
/// @see     Crane, Weischedel and Wardetzky 2013; CGAL Heat_method_3
/// @throws  BakeError "transition.distance-failed"
std::vector<Eigen::VectorXd> geodesic_distances(const Mesh& mesh, const std::vector<PointSet>& sets,
                                                const Location& where = {});

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
