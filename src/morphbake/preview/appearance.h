#pragma once

#include <Eigen/Core>
#include <vector>

#include "morphbake/diagnostics/observer.h"
#include "morphbake/gltf/animated_mesh.h"
#include "morphbake/images/images.h"
#include "morphbake/preview/ray_scene.h"

namespace morphbake {

/// A texture and its halved copies, down to one pixel.
using MipLevels = std::vector<Image>;

/// Colours of a mesh's primitives, ready to be looked up.
struct Appearance {
  std::vector<MipLevels> textures;  ///< one an image of the mesh; empty when no primitive uses it,
                                    ///< or when it cannot be decoded
  std::vector<Eigen::Array3f> factors;  ///< one a primitive: linear RGB, clay if it has no colour
};

/// Decodes the base-colour textures of `mesh`.
///
/// A texture that cannot be decoded is told as a warning, and what it covers has its factor and
/// vertex colours alone: a picture is no reason to lose a morph.
Appearance make_appearance(const AnimatedMesh& mesh, const Observer& observer = {});

/// The primitive's texture, or none.
const MipLevels* texture_of(const AnimatedPrimitive& primitive, const Appearance& appearance);

/// Linear RGB of the base-colour factor times COLOR_0 times the texture at `hit` (glTF 2.0, 3.9.2).
///
/// @param colours    of the primitive that is hit: #V by 3 COLOR_0, morphed, or no rows
/// @param footprint  width of a sample on the surface, studio units; chooses the texture's level
/// @param triangle_area  studio units squared
Eigen::Array3f base_colour_at(const AnimatedMesh& mesh, const Appearance& appearance,
                              const Float3s& colours, const RayHit& hit, float footprint,
                              float triangle_area);

/// Linear RGB of a texture at `uv` (repeating; 0, 0 is the top left corner) between the two levels
/// around `level` (0 is the full picture), bilinear in each.
Eigen::Array3f texture_at(const MipLevels& texture, const Eigen::Vector2f& uv, float level);

}  // namespace morphbake
