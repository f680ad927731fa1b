#pragma once

// Internal to gltf/: that what a file refers to is there.

#include "morphbake/gltf/document.h"

namespace morphbake {

/// Checks each index of glTF itself and of compressed geometry and pictures, whether it is of use
/// to us or not: what is written would dangle likewise.
///
/// @param document  its JSON, of which the types of fields were checked
/// @throws BakeError "gltf.invalid" for the first that is beyond the end of its list
void check_references(const GltfDocument& document);

}  // namespace morphbake
