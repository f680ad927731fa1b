#pragma once

#include "morphbake/bake/options.h"
#include "morphbake/bake/solve_timeline.h"
#include "morphbake/images/images.h"

namespace morphbake {

/// One picture of all regions: each on the shape that it is measured on, red inside, yellow where d
/// is a half, grey outside, seen from where most of it is. Regions that move or flood are shown at
/// a quarter, a half and three quarters of their way.
///
/// @param recipe  with a region
Image region_sheet(const Recipe& recipe, const MorphableMesh& mesh, const RegionFields& regions,
                   const BakeOptions& options, const Observer& observer);

/// Which source dominates where: poses over the timeline, each vertex in the colours of the sources
/// mixed by its shares, with a legend.
Image share_sheet(const Recipe& recipe, const MorphableMesh& mesh, const RegionFields& regions,
                  const SolvedTimeline& timeline, const BakeOptions& options);

}  // namespace morphbake
