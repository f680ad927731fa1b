#pragma once

#include <optional>
#include <vector>

#include "morphbake/gltf/animated_mesh.h"
#include "morphbake/gltf/write_mesh.h"
#include "morphbake/sources/source_mesh.h"
#include "morphbake/sources/source_surface.h"

namespace morphbake {

/// What a source's surface looks like at given points, without textures.
struct CarriedColours {
  std::optional<PlainMaterial> material;
  Float3s colours;  ///< one a point: COLOR_0, or no rows when the material says it all
};

/// The colours of a source at points of its surface: COLOR_0 between the corners, times the
/// base-colour texture there and the material's factor, which is white then. What is finer than the
/// points is lost. Where one factor says it all it stays, without COLOR_0.
///
/// Warns of textures as make_appearance.
CarriedColours carry_colours(const SourceMesh& source, const SourceSurface& surface,
                             const std::vector<SurfacePoint>& points, const Observer& observer);

}  // namespace morphbake
