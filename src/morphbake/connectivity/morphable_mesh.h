#pragma once

#include <string>
#include <vector>

#include "morphbake/mesh/mesh.h"
#include "morphbake/sources/corner_surface.h"
#include "morphbake/sources/source_mesh.h"

namespace morphbake {

/// One connectivity K with a geometry V_i a source (Alexa 2003, section 2).
struct MorphableMesh {
  Connectivity connectivity;          ///< wound counter-clockwise in scene space
  std::vector<Positions> geometries;  ///< one a source: #V by 3, scene space
  std::vector<std::string> names;     ///< one a source
  std::vector<int> vertex_of_render;  ///< render vertex of the first source -> vertex of K, -1 when
                                      ///< no triangle uses it
  std::vector<int> render_of_corner;  ///< 3 #F: corner 3 f + k of K -> render vertex of the first
                                      ///< source
  std::vector<int> triangle_of_file;  ///< triangle of the first source's file -> of K: duplicates
                                      ///< share one, degenerate ones have -1
  SurfaceRepairs repairs;             ///< of the first source's triangles
};

/// Joins sources that share topology and face order: the paper's K is theirs.
///
/// A vertex of K is a set of triangle corners that lie at one point in *every* source; so a
/// triangle is degenerate or a duplicate only when it is in every source. Sources either have the
/// same vertex order, or split vertices differently but agree triangle by triangle once welded.
/// @param sources  one or more
/// @throws BakeError "connectivity.different-triangles", "connectivity.different-topology",
///         "connectivity.not-manifold", "connectivity.empty"
MorphableMesh share_connectivity(const std::vector<SourceMesh>& sources);

}  // namespace morphbake
