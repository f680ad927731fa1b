#pragma once

#include <string>

#include "morphbake/gltf/gltf_file.h"

namespace morphbake {

/// The same .glb with the bufferViews of its accessors compressed, without loss
/// (EXT_meshopt_compression); those that would grow, and images, stay as they are.
///
/// @throws BakeError "output.too-large"
std::string compress_meshopt(const GltfFile& file);

}  // namespace morphbake
