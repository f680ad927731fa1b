#pragma once

#include <string>
#include <vector>

#include "morphbake/diagnostics/observer.h"
#include "morphbake/mesh/mesh.h"
#include "morphbake/recipe/recipe.h"
#include "morphbake/sources/corner_surface.h"
#include "morphbake/sources/source_mesh.h"

namespace morphbake {

/// The surface of one source by itself: welded, mended by surface_of_corners, wound
/// counter-clockwise in scene space, an oriented manifold.
struct SourceSurface {
  std::string name;
  std::string file;                         ///< for messages
  Mesh mesh;                                ///< scene space
  std::vector<int> vertex_of_render;        ///< #R: -1 when no triangle uses the render vertex
  std::vector<int> render_of_corner;        ///< 3 #F: corner 3 f + k -> render vertex
  std::vector<Eigen::Vector2i> hard_edges;  ///< vertices a < b of edges where shading breaks
  std::vector<std::string> landmark_names;
  std::vector<SurfacePoint> landmarks;  ///< one a name
  SurfaceRepairs repairs;
};

/// The surface of one source and where its landmarks are on it.
///
/// Landmarks are put on the surface by landmark_points, hard edges found by find_hard_edges. Warns
/// as surface_warnings.
/// @param ref  gives the landmarks
/// @throws BakeError "connectivity.empty", "connectivity.not-manifold", "landmarks...."; Cancelled
SourceSurface source_surface(const SourceMesh& source, const SourceRef& ref,
                             const Observer& observer);

/// The same, but all that would be thrown is added to `problems`: then a surface that is no
/// manifold comes without triangles, and landmarks that cannot be placed leave only their names.
SourceSurface source_surface(const SourceMesh& source, const SourceRef& ref,
                             const Observer& observer, std::vector<Problem>& problems);

}  // namespace morphbake
