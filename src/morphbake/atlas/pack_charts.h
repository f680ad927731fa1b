#pragma once

#include <vector>

#include "morphbake/atlas/flatten_chart.h"
#include "morphbake/diagnostics/observer.h"

namespace morphbake {

/// Lays charts on a square picture of `size` texels, as large as they fit, all at one scale.
///
/// Charts stand upright in their smallest box and are put on the skyline of those before, large
/// ones first, where they leave the least below them (Lévy, Petitjean, Ray, Maillot 2002). Places
/// become texels, y downwards; charts stay 2 * `padding` texels apart and `padding` from the edge.
/// @return texels a unit of the surface; 0 when even points find no room
/// @throws Cancelled
double pack_charts(std::vector<FlatChart>& charts, int size, int padding,
                   const Observer& observer = {});

}  // namespace morphbake
