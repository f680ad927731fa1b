#pragma once

#include <vector>

#include "morphbake/bake/connect_sources.h"
#include "morphbake/bake/options.h"
#include "morphbake/images/images.h"

namespace morphbake {

/// One picture to judge a new connectivity by: a row a source, with the source itself, its new
/// triangles with landmarks, the same checker on all, and their distortion.
///
/// The checker is laid on the first source and carried to the others by vertex: equal cells are
/// equal places. Heat is the mean distortion around a vertex between the first source and this one
/// (on the first, the largest to any other): grey-white where the map is an isometry, yellow,
/// orange, and red at 5 and above.
/// @throws BakeError as render_turntable; Cancelled
Image connectivity_sheet(const std::vector<SourceMesh>& sources, const RemeshedSources& remeshed,
                         const BakeOptions& options, const Observer& observer);

}  // namespace morphbake
