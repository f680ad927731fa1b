#pragma once

#include <vector>

#include "morphbake/sources/corner_surface.h"
#include "morphbake/sources/source_mesh.h"

namespace morphbake {

/// The edges of a surface at which its file breaks the shading.
///
/// An edge is hard where the file's NORMALs of its two triangles differ by more than 5 degrees at
/// both ends. A file whose triangles are flat (it has no NORMAL, or more than half of all edges
/// would be hard by their normals) says nothing by its normals; there an edge is hard where its
/// triangles also meet at more than 40 degrees. Edges of the boundary are not hard.
/// @param mesh  `surface` in the scene
/// @return      vertices a < b of each, sorted
std::vector<Eigen::Vector2i> find_hard_edges(const SourceMesh& source, const CornerSurface& surface,
                                             const Mesh& mesh);

}  // namespace morphbake
