#pragma once

#include <string>
#include <vector>

#include "morphbake/diagnostics/problem.h"
#include "morphbake/mesh/mesh.h"
#include "morphbake/sources/source_mesh.h"

namespace morphbake {

/// What was mended in a file's triangles before anything was computed on them. The file itself
/// stays as it is.
struct SurfaceRepairs {
  int degenerate = 0;  ///< triangles with two corners at one point: dropped
  int duplicate = 0;  ///< triangles over the three points of an earlier one, however wound: dropped
  int turned = 0;     ///< triangles that ran against most others of their piece: turned

  bool any() const { return degenerate + duplicate + turned > 0; }
};

/// A surface whose vertices are classes of a file's triangle corners: those that lie at one point.
struct CornerSurface {
  Connectivity connectivity;
  std::vector<int> vertex_of_corner;  ///< 3 #triangles of the file: -1 when no triangle uses it
  std::vector<int> file_corner;       ///< 3 #F: corner of the surface -> corner of the file
  std::vector<int> triangle_of_file;  ///< triangle of the file -> of the surface: a duplicate has
                                      ///< that of the earlier one, a degenerate one -1
  SurfaceRepairs repairs;
};

/// Welded vertex of each corner of a source's triangles, corner 3 f + k.
std::vector<int> welded_corners(const SourceMesh& source);

/// The surface of a file's triangles, mended: degenerate and duplicate triangles are dropped, the
/// rest is wound as it is seen in the scene (a node that mirrors turns them all; glTF 2.0, 3.7.4)
/// and, in each piece that has two sides, as most of its triangles.
///
/// Triangles keep the file's order; vertices are numbered by first appearance. A vertex that only
/// degenerate triangles use is left out: nothing of it is seen.
/// @param corner_classes  class of each corner of the source's triangles
/// @see                   find_orientation
CornerSurface surface_of_corners(const SourceMesh& source, const std::vector<int>& corner_classes);

/// Vertex of the surface that each render vertex is, -1 where none.
std::vector<int> vertices_of_render(const SourceMesh& source, const CornerSurface& surface);

/// Render vertex of each corner of the surface.
std::vector<int> render_corners(const SourceMesh& source, const CornerSurface& surface);

/// Where the surface's vertices lie in a source that has them as corners: #V by 3, scene space.
Positions vertex_positions(const SourceMesh& source, const CornerSurface& surface);

/// Whether the triangle of the surface runs as the file's.
bool runs_as_in_file(const CornerSurface& surface, int triangle);

/// The warnings "connectivity.repaired" and "connectivity.open-seams", where there is a reason.
///
/// @param first       whose file was mended
/// @param names       of the sources that have the surface
/// @param geometries  where its vertices lie in each of them, #V by 3
std::vector<Problem> surface_warnings(const SourceMesh& first,
                                      const std::vector<std::string>& names,
                                      const Triangles& triangles,
                                      const std::vector<Positions>& geometries,
                                      const SurfaceRepairs& repairs);

/// @param positions  of the surface's vertices, for messages
/// @throws BakeError "connectivity.empty", "connectivity.not-manifold" with the first places
void check_manifold(const SourceMesh& source, const Connectivity& connectivity,
                    const Positions& positions);

/// Checks what new triangles can be laid over: CGAL and our own walks look around a vertex for each
/// of its triangles.
///
/// @throws BakeError "connectivity.hub" when more than 16384 triangles meet at a vertex
void check_hubs(const SourceMesh& source, const Connectivity& connectivity,
                const Positions& positions);

/// @throws BakeError with a problem of the source's mesh
[[noreturn]] void fail_source(const SourceMesh& source, const std::string& code,
                              const std::string& message, const std::string& hint);

}  // namespace morphbake
