#pragma once

#include <string>
#include <vector>

#include "morphbake/images/images.h"

namespace morphbake {

/// Pictures beside one another, each below a strip with its caption.
///
/// Letters grow with the pictures, so that from 300 pixels on they are still read when a contact
/// sheet halves them; captions that are too long lose their middles.
/// @param pictures  one or more of one size
/// @param captions  one a picture
/// @param note      stands at the right end of the last strip where there is room
Image captioned_row(const std::vector<Image>& pictures, const std::vector<std::string>& captions,
                    const std::string& note);

}  // namespace morphbake
