#pragma once

#include <vector>

#include "morphbake/diagnostics/observer.h"
#include "morphbake/sources/source_surface.h"

namespace morphbake {

/// What is wrong with the names of landmarks: "landmarks.too-few" when fewer than three are common,
/// "landmarks.missing" with the names that some sources lack; that is a warning by itself.
///
/// @param surfaces  one or more, of which only the names are looked at
/// @param refs      of the surfaces: where their landmarks stand, for messages
std::vector<Problem> common_landmark_problems(const std::vector<SourceSurface>& surfaces,
                                              const std::vector<SourceRef>& refs);

/// The same surfaces with the landmarks that all of them have, in the first one's order.
///
/// Warns "landmarks.missing" when that leaves out landmarks that only some sources have.
/// @param surfaces  one or more
/// @throws BakeError as common_landmark_problems, when landmarks are too few
std::vector<SourceSurface> with_common_landmarks(std::vector<SourceSurface> surfaces,
                                                 const std::vector<SourceRef>& refs,
                                                 const Observer& observer);

}  // namespace morphbake
