#pragma once

#include <utility>
#include <vector>

#include "morphbake/diagnostics/observer.h"
#include "morphbake/mesh/mesh.h"

namespace morphbake {

/// By how much the report's distances may be too small, as a fraction of the diagonal.
constexpr double kHausdorffBound = 1e-4;

/// The largest distance of any point of `from` to `to`, too small by at most `error_bound`.
///
/// @throws Cancelled
/// @see    CGAL bounded_error_Hausdorff_distance
double hausdorff_distance(const Mesh& from, const Mesh& to, double error_bound,
                          const Observer& observer = {});

/// Triangles that face against their source: at its point nearest to their middle and, by the map,
/// at their corners.
///
/// The nearest point alone would not do: where two sheets lie close to one another, as lips do, it
/// may be on the other one.
/// @param on_source  where the vertices of `remesh` lie on `source`
/// @throws Cancelled
std::vector<int> folded_triangles(const Mesh& source, const Mesh& remesh,
                                  const std::vector<SurfacePoint>& on_source,
                                  const Observer& observer = {});

/// Pairs that are looked for: a tangled surface has the square of its size.
constexpr int kMostSelfIntersections = 200000;

/// Pairs of triangles that meet elsewhere than at a common vertex or edge; triangles without area
/// count as well. At most kMostSelfIntersections of them.
///
/// @param mesh  an oriented manifold
/// @throws Cancelled
std::vector<std::pair<int, int>> self_intersections(const Mesh& mesh,
                                                    const Observer& observer = {});

/// Marks the triangles that take part in self-intersections, and those that share a vertex with
/// one.
///
/// @throws Cancelled
std::vector<char> triangles_near_cuts(const Mesh& mesh, const Observer& observer = {});

/// Of pairs of triangles of `remesh` that cut one another those that do not both lie where the
/// source cuts itself.
///
/// @param near_cuts  triangles_near_cuts(source)
std::vector<std::pair<int, int>> new_cuts(const std::vector<std::pair<int, int>>& pairs,
                                          const Mesh& remesh, const Mesh& source,
                                          const std::vector<char>& near_cuts);

}  // namespace morphbake
