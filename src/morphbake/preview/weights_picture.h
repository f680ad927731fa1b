#pragma once

#include <string>
#include <vector>

#include "morphbake/gltf/animated_mesh.h"
#include "morphbake/images/images.h"

namespace morphbake {

/// Draws weights over time: a strip a target, one below the other, each with its name and colour
/// and all on one scale, which reaches from 0 to 1 or as far as the weights do.
///
/// @param curve  one number a target
/// @param names  one a target; "" is shown by its number. Of more than 500 targets the first are
///               drawn
/// @param title  what stands on top
Image draw_weights(const AnimationCurve& curve, const std::vector<std::string>& names,
                   const std::string& title);

}  // namespace morphbake
