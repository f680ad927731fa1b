#pragma once

#include <string>
#include <vector>

#include "morphbake/mesh/mesh.h"
#include "morphbake/sources/source_mesh.h"

namespace morphbake {

/// A surface whose vertices are classes of a file's triangle corners: those that lie at one point.
struct CornerSurface {
  Connectivity connectivity;
  std::vector<int> vertex_of_corner;  ///< 3 #triangles of the file: -1 when no triangle uses it
  std::vector<int> file_corner;       ///< 3 #F: corner of the surface -> corner of the file
};

/// Welded vertex of each corner of a source's triangles, corner 3 f + k.
std::vector<int> welded_corners(const SourceMesh& source);

/// The triangles whose three corners are of different classes.
std::vector<int> proper_triangles(const std::vector<int>& corner_classes);

/// `triangles` without those over the same three classes as an earlier one, however turned.
std::vector<int> without_duplicates(const std::vector<int>& corner_classes,
                                    const std::vector<int>& triangles);

/// The surface of these triangles of a file, its vertices numbered by first appearance.
///
/// @param corner_classes  class of each corner of the file's triangles
/// @param triangles       rising
CornerSurface surface_of_corners(const std::vector<int>& corner_classes,
                                 const std::vector<int>& triangles);

/// Turns the triangles when the source's node mirrors its mesh (glTF 2.0, 3.7.4): a surface is
/// wound as it is seen in the scene.
void wind_as_seen(const SourceMesh& source, CornerSurface& surface);

/// Render vertex of each corner of the surface.
std::vector<int> render_corners(const SourceMesh& source, const CornerSurface& surface);

/// Where the surface's vertices lie in a source that has them as corners: #V by 3, scene space.
Positions vertex_positions(const SourceMesh& source, const CornerSurface& surface);

/// @param positions  of the surface's vertices, for messages
/// @throws BakeError "connectivity.empty", "connectivity.not-manifold" with the first places
void check_manifold(const SourceMesh& source, const Connectivity& connectivity,
                    const Positions& positions);

/// @throws BakeError with a problem of the source's mesh
[[noreturn]] void fail_source(const SourceMesh& source, const std::string& code,
                              const std::string& message, const std::string& hint);

}  // namespace morphbake
