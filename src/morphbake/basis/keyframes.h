#pragma once

#include <cstddef>
#include <vector>

#include "morphbake/basis/frame_blocks.h"

namespace morphbake {

/// Few frames between which all others lie on straight ways: from each the farthest next one whose
/// way stays within the tolerance. The first and the last frame are among them.
///
/// @param tolerance  scene units, > 0
/// @return           frames, rising
/// @cost             reads all frames two to five times
std::vector<std::size_t> choose_keyframes(const FrameSource& frames, double tolerance,
                                          const Observer& observer);

}  // namespace morphbake
