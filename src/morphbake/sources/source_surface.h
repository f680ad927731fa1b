#pragma once

#include <string>
#include <vector>

#include "morphbake/mesh/mesh.h"
#include "morphbake/sources/source_mesh.h"

namespace morphbake {

/// The surface of one source by itself: welded, without degenerate triangles, wound
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
};

}  // namespace morphbake
