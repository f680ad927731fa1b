#pragma once

#include <string>
#include <vector>

#include "morphbake/diagnostics/observer.h"
#include "morphbake/sources/source_surface.h"

namespace morphbake {

/// Landmarks that a map between sources needs: two points leave a turn about both open.
constexpr std::size_t kFewestLandmarks = 3;

/// The names that all sources have, in the first one's order.
///
/// @param sources  one or more
std::vector<std::string> common_landmark_names(const std::vector<SourceRef>& sources);

/// What is wrong with the names of landmarks: "landmarks.too-few" when fewer than kFewestLandmarks
/// are common, "landmarks.missing" with the names that some sources lack; that is a warning by
/// itself.
std::vector<Problem> common_landmark_problems(const std::vector<SourceRef>& sources);

/// The surfaces of `sources` with the landmarks that all of them have, in the first one's order.
///
/// Warns "landmarks.missing" when that leaves out landmarks that only some sources have.
/// @throws BakeError as common_landmark_problems, when landmarks are too few
std::vector<SourceSurface> with_common_landmarks(std::vector<SourceSurface> surfaces,
                                                 const std::vector<SourceRef>& sources,
                                                 const Observer& observer);

}  // namespace morphbake
