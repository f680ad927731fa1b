#pragma once

#include <array>
#include <utility>
#include <vector>

#include "morphbake/connectivity/layered_triangulation.h"
#include "morphbake/connectivity/refine.h"

namespace morphbake {

using Corners = std::array<int, 3>;

inline Corners corners_of(const LayeredTriangulation& t, int f) {
  return {t.mesh.from(3 * f), t.mesh.from(3 * f + 1), t.mesh.from(3 * f + 2)};
}

/// Keeps which source vertices lie under which triangle, and tells whether a change of some
/// triangles leaves the sources near to them. Distances are fractions of the diagonal.
class SourceGuard {
 public:
  /// @param points  where the source vertices lie, as source_errors leaves them; kept up to date
  SourceGuard(const LayeredTriangulation& t, SourcePoints& points, double tolerance);

  /// Whether the sources stay as near to new triangles as they were to old ones, or within the
  /// tolerance.
  bool stays_near(const std::vector<int>& old_triangles, const std::vector<Corners>& new_triangles,
                  const std::vector<std::array<int, 2>>& new_edges) const;

  /// Whether the borders stay near when border vertex u goes into its neighbour v.
  bool border_stays_near(int u, int v) const;

  /// Vertices and edge middles of a source around some triangles.
  std::vector<Eigen::Vector3d> samples(std::size_t s, const std::vector<int>& triangles,
                                       const std::vector<std::array<int, 2>>& edges) const;

  /// Largest distance of points from triangles of one layer.
  double largest_distance(std::size_t s, const std::vector<Eigen::Vector3d>& from,
                          const std::vector<Corners>& triangles) const;

  /// How far the middles of new triangles and edges stand off the source, seen along its normal.
  double stand_off(std::size_t s, const std::vector<Corners>& triangles,
                   const std::vector<std::array<int, 2>>& edges) const;

  /// Hands the source vertices below old triangles to those that are there now.
  void hand_over(const std::vector<int>& old_triangles, const std::vector<int>& new_triangles);

 private:
  /// Largest distance of a source's border between two border vertices from a chain of them.
  double border_distance(std::size_t s, const std::vector<int>& chain) const;

  const LayeredTriangulation& t_;
  SourcePoints& points_;
  double tolerance_;
  std::vector<std::vector<std::vector<int>>> below_;          ///< layer, triangle: source vertices
  std::vector<std::vector<std::pair<double, int>>> borders_;  ///< one a layer
};

}  // namespace morphbake
