#pragma once

#include "morphbake/bake/options.h"
#include "morphbake/connectivity/mismatch.h"
#include "morphbake/images/images.h"
#include "morphbake/sources/source_mesh.h"

namespace morphbake {

/// One picture of where two sources are not connected alike: the first on the left, the other on
/// the right, triangles that differ in red, rings around the places that a message names. Both are
/// turned so that the first place is seen; a second row shows it from close by.
///
/// @param mismatch  with at least one place
/// @throws BakeError as render_still; Cancelled
Image mismatch_picture(const SourceMesh& first, const SourceMesh& other,
                       const TopologyMismatch& mismatch, const BakeOptions& options,
                       const Observer& observer);

}  // namespace morphbake
