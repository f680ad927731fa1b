#pragma once

// Internal to recipe/: what read_regions and read_spatial share.

#include <string>

#include "morphbake/recipe/reading.h"

namespace morphbake {

/// In which way a region is given: "ball", ..., or "".
std::string kind_of(const Json& region);

SpatialRegion read_spatial(Reading& reading, const Json& json, const std::string& pointer);

}  // namespace morphbake
