#pragma once

#include <Eigen/Core>
#include <functional>
#include <vector>

#include "morphbake/atlas/atlas.h"
#include "morphbake/diagnostics/observer.h"
#include "morphbake/images/images.h"
#include "morphbake/mesh/mesh.h"

namespace morphbake {

/// What of the surface a texel shows.
struct AtlasTexel {
  SurfacePoint at;   ///< of the mesh: the point of its chart that is nearest to the texel's centre
  double width = 0;  ///< of the texel on the surface, in units of the positions
};

/// Linear RGB in [0, 1] of texels of one row, from left to right. Asked on several threads at once;
/// must not depend on which rows were asked for before.
using TexelColours =
    std::function<std::vector<Eigen::Array3f>(const std::vector<AtlasTexel>& texels)>;

/// Paints the charts and `padding` texels around them with the surface's colours.
///
/// The rest is filled with means of what is near (pull-push, Grossman and Dally 1998), so that
/// coarse mip levels have no foreign colour in them.
/// @param mesh  of which `atlas` was made
/// @return      atlas.size squared, sRGB
/// @throws Cancelled
/// @cost        O(#texels); 10 bytes a texel; the result does not depend on the number of threads
Image paint_atlas(const Atlas& atlas, const Mesh& mesh, const TexelColours& colours,
                  const Observer& observer = {});

}  // namespace morphbake
