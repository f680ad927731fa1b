#pragma once

#include "morphbake/bake/bake.h"

namespace morphbake {

/// Whether what was written keeps the output's bounds on positions and normals.
bool keeps_bounds(const Output& output, const OutputReport& written);

/// Tells bounds that are not kept: as errors, or as warnings where the output says so.
///
/// @throws BakeError "export.position-error", "export.normal-error"
void check_bounds(const Recipe& recipe, std::size_t index, const OutputReport& written,
                  const Observer& observer);

}  // namespace morphbake
