#pragma once

#include <vector>

#include "morphbake/diagnostics/observer.h"
#include "morphbake/sources/source_surface.h"

namespace morphbake {

/// The same surfaces with the landmarks that all of them have, in the first one's order.
///
/// Warns "landmarks.missing" when that leaves out landmarks that only some sources have.
/// @param surfaces  one or more
/// @throws BakeError "landmarks.too-few" when fewer than three are common, and "landmarks.missing"
///         with the names that some sources lack
std::vector<SourceSurface> with_common_landmarks(std::vector<SourceSurface> surfaces,
                                                 const Observer& observer);

}  // namespace morphbake
