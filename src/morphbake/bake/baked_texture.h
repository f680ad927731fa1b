#pragma once

#include <string>
#include <vector>

#include "morphbake/atlas/atlas.h"
#include "morphbake/bake/surface_colours.h"
#include "morphbake/connectivity/shared_triangulation.h"
#include "morphbake/gltf/write_mesh.h"
#include "morphbake/recipe/recipe.h"

namespace morphbake {

/// One source's look, as a texture for the new triangles.
struct BakedTexture {
  Atlas atlas;
  PlainMaterial material;  ///< of the source, white, with the texture
};

/// The colours of the source that the recipe's texture is of.
///
/// @param recipe  with a texture
/// @throws BakeError "connectivity.no-colours" when they are the same everywhere
SurfaceColours texture_colours(const Recipe& recipe, const std::vector<SourceMesh>& sources,
                               const std::vector<SourceSurface>& surfaces,
                               const Observer& observer);

/// Cuts the new triangles into charts as they lie on the texture's source, and paints each texel as
/// that source is at its closest point that faces the same way.
///
/// @param surface  of that source, which has the `colours`
/// @throws BakeError "connectivity.texture-too-small"; Cancelled
BakedTexture bake_texture(const Recipe& recipe, const SourceSurface& surface,
                          const SurfaceColours& colours, const SharedTriangulation& triangulation,
                          const Observer& observer);

}  // namespace morphbake
