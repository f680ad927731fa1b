#pragma once

#include <memory>
#include <vector>

#include "morphbake/diagnostics/problem.h"
#include "morphbake/mesh/adjacency.h"
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

/// Geodesic distances over a surface, by the heat method on an intrinsic Delaunay triangulation.
///
/// Error 1-4 % of the distance; it grows where triangles are large against it. Distances are #V, in
/// scene units, 0 or more; infinity on components from which no point of theirs is asked.
/// @cost    one factorisation a component, when it is first asked about
/// @see     Crane, Weischedel and Wardetzky 2013; CGAL Heat_method_3
class GeodesicDistances {
 public:
  /// @param mesh   must outlive this
  /// @param sets   points from which distances will be asked: they become vertices of their own
  ///               (their triangles or edges are split), never the nearest ones; no set is empty
  /// @param where  the place that a failure is told at
  explicit GeodesicDistances(const Mesh& mesh, std::vector<PointSet> sets = {},
                             Location where = {});
  ~GeodesicDistances();
  GeodesicDistances(GeodesicDistances&&) noexcept;

  /// From the nearest point of the i-th set.
  /// @throws BakeError "transition.distance-failed"
  Eigen::VectorXd from_set(std::size_t i);

  /// From the nearest of several vertices.
  /// @throws BakeError "transition.distance-failed"
  Eigen::VectorXd from_vertices(const std::vector<int>& vertices);

 private:
  struct Component;
  Component& component(int label);
  int label_of(const SurfacePoint& at) const;

  const Mesh* mesh_;
  std::vector<PointSet> sets_;
  Location where_;
  Components components_;
  std::vector<std::unique_ptr<Component>> asked_;  ///< one a component, none: not asked about yet
};

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
