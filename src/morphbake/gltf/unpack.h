#pragma once

// Internal to gltf/: files with compressed geometry, as files without.

#include <string>

#include "morphbake/gltf/document.h"

namespace morphbake {

/// Whether a checked file has bufferViews or primitives that are compressed.
bool is_packed(const Json& json);

/// The bytes of a .glb that says the same as `document`'s JSON without KHR_draco_mesh_compression
/// and EXT_meshopt_compression. Images keep their URIs.
///
/// @throws BakeError "gltf.meshopt", "gltf.draco", "gltf.invalid", "gltf.too-large"
std::string unpacked_glb(const GltfDocument& document);

}  // namespace morphbake
