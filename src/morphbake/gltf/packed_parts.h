#pragma once

// Internal to gltf/: the two compressions, a part at a time.

#include <string>
#include <string_view>
#include <vector>

#include "morphbake/gltf/document.h"
#include "morphbake/gltf/size_limits.h"

namespace morphbake {

constexpr const char* kMeshopt = "EXT_meshopt_compression";
constexpr const char* kDraco = "KHR_draco_mesh_compression";

/// The bytes of a bufferView that meshoptimizer compressed.
///
/// @param extension  EXT_meshopt_compression of the bufferView
/// @param packed     what the extension says is compressed
/// @param pointer    of the extension, for messages
/// @throws BakeError "gltf.meshopt", "gltf.too-large"
std::string unpack_meshopt(const GltfDocument& document, const Json& extension,
                           std::string_view packed, UnpackBudget& budget,
                           const std::string& pointer);

/// An accessor that Draco compressed: where its numbers go, and as what.
struct PackedAttribute {
  int id = 0;  ///< of the attribute in the Draco data
  int component_type = 0;
  int columns = 0;
  std::size_t count = 0;  ///< elements that the accessor has
};

/// A primitive that Draco compressed.
struct UnpackedPrimitive {
  std::vector<std::uint32_t> indices;
  std::vector<std::string> attributes;  ///< bytes, tight; one an attribute that was asked for
};

/// @param packed   the bufferView of the extension
/// @param indices  elements that the accessor of the indices has
/// @param pointer  of the extension, for messages
/// @throws BakeError "gltf.draco", "gltf.too-large"
UnpackedPrimitive unpack_draco(const GltfDocument& document, std::string_view packed,
                               std::size_t indices, const std::vector<PackedAttribute>& attributes,
                               UnpackBudget& budget, const std::string& pointer);

}  // namespace morphbake
