#pragma once

#include <string>
#include <vector>

#include "morphbake/gltf/gltf_file.h"
#include "morphbake/gltf/source_geometry.h"
#include "morphbake/mesh/mesh.h"
#include "morphbake/recipe/recipe.h"

namespace morphbake {

/// A source as it was loaded. "Render vertices" are the file's own, of all primitives one after the
/// other: UV seams and hard edges split them. "Welded vertices" are the points of the surface.
struct SourceMesh {
  std::string name;
  GltfFile file;
  SourceGeometry geometry;
  Positions positions;  ///< #R by 3, render vertices in scene space
  Triangles triangles;  ///< #F by 3, render vertices, the file's winding
  std::vector<int>
      welded;  ///< #R, render vertex -> welded vertex: equal exactly when the positions are
  int welded_count = 0;
};

/// Opens a source's file, reads its mesh into scene space and welds it by exact position.
///
/// @throws BakeError "gltf...."
SourceMesh load_source(const SourceRef& source);

/// As load_source, of a file that is open.
SourceMesh read_source(const std::string& name, const GltfFile& file,
                       const MeshChoice& choice = {});

/// NORMAL of each render vertex, mesh space, or no rows when a primitive has none.
Float3s file_normals(const SourceMesh& source);

/// Vertex of each row, equal exactly when rows are; numbered by first appearance.
std::vector<int> weld_rows(const Positions& positions, int& welded_count);

}  // namespace morphbake
