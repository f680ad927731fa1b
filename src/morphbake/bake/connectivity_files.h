#pragma once

#include <optional>
#include <string>
#include <vector>

#include "morphbake/bake/baked_texture.h"
#include "morphbake/connectivity/shared_triangulation.h"
#include "morphbake/sources/source_mesh.h"
#include "morphbake/sources/source_surface.h"

namespace morphbake {

/// The sources on their new connectivity, as they stand in files.
struct ConnectivityFiles {
  std::vector<std::string> glbs;  ///< one a source: bytes of a .glb
  std::string maps;               ///< where each vertex lies on each source; see docs/maps.md
};

/// Writes every source on the shared triangulation: vertices in one order, split only at hard
/// edges, at which shading breaks, and between charts of a texture.
///
/// Vertices of the triangulation come first, in its order; the copies follow.
/// @param texture  which all files get in the stead of their own colours
/// @throws BakeError as carry_colours and write_mesh_glb; Cancelled
ConnectivityFiles write_connectivity_files(const std::vector<SourceMesh>& sources,
                                           const std::vector<SourceSurface>& surfaces,
                                           const SharedTriangulation& triangulation,
                                           const std::optional<BakedTexture>& texture,
                                           const Observer& observer);

}  // namespace morphbake
