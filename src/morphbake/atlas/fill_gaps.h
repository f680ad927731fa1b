#pragma once

#include <vector>

#include "morphbake/images/images.h"

namespace morphbake {

/// Gives pixels that are not `known` the mean of known ones near them; black where none is known.
///
/// @param known  width * height
/// @see Grossman and Dally 1998, section 7: pull-push
void fill_gaps(Image& image, const std::vector<char>& known);

}  // namespace morphbake
