#pragma once

#include <vector>

#include "morphbake/connectivity/remesh_options.h"
#include "morphbake/correspondence/spherical_map.h"
#include "morphbake/diagnostics/observer.h"
#include "morphbake/mesh/mesh.h"

namespace morphbake {

/// One triangulation that lies on every source.
struct SharedTriangulation {
  Connectivity connectivity;
  std::vector<Positions> geometries;                 ///< one a source: #V by 3, scene space
  std::vector<std::vector<SurfacePoint>> on_source;  ///< one a source: #V on SourceSurface::mesh
  std::vector<Positions> sphere;            ///< one a source: #V by 3, or empty without a sphere
  std::vector<int> landmarks;               ///< vertex of each landmark
  std::vector<char> on_boundary;            ///< #V
  std::vector<Eigen::Vector2i> hard_edges;  ///< a < b, of any source
  int rounded_hard_edges = 0;               ///< of sources: those for which there was no room
  bool is_full = false;                     ///< max_vertices ended the refinement
};

/// Triangulates all sources alike over the sphere on which they lie.
///
/// Starts coarse from the first source, relaxes for low distortion, inserts the worst source
/// vertices until every source is met within `max_error`, repairs, and lays edges along the
/// sources' hard edges.
/// @param maps  of map_to_sphere
/// @throws BakeError "connectivity...."; Cancelled
SharedTriangulation triangulate(const std::vector<SphericalMap>& maps, const RemeshOptions& options,
                                const Observer& observer);

/// Gives sources that share their connectivity a new one, of even edges.
///
/// CGAL's isotropic remeshing of the first source; each new vertex is carried to the others by its
/// barycentric coordinates. Boundary curves and hard edges are only ever split. The first source's
/// landmarks are vertices, at the same place of the connectivity in every source. CGAL 5.5 has no
/// sizing by curvature: Sizing::Curvature makes all edges finer, from target_edge_length, until
/// every source is met within max_error or max_vertices is reached; Sizing::Uniform does not look
/// at max_error.
/// @param surfaces  with equal triangles; the first is an oriented manifold by itself, too
/// @throws BakeError "connectivity.different-triangles", "connectivity.no-area",
///         "connectivity.too-many-vertices"; Cancelled
SharedTriangulation resample(const std::vector<SourceSurface>& surfaces,
                             const RemeshOptions& options, const Observer& observer);

}  // namespace morphbake
