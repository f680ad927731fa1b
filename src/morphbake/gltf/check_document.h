#pragma once

// Internal to gltf/: what is checked in a file's JSON before anything of it is used.

#include <cstddef>
#include <string_view>

#include "morphbake/gltf/document.h"

namespace morphbake {

/// Version, required extensions, types and ranges of fields, URIs, bufferViews and sizes.
///
/// @param document    its JSON, nothing else yet
/// @param file_bytes  of the glTF itself
/// @throws BakeError as open_gltf
void check_document(const GltfDocument& document, std::size_t file_bytes);

/// Whether it is known what an extension means: a file may require it, and what it refers to is
/// known.
bool is_known_extension(std::string_view name);

}  // namespace morphbake
