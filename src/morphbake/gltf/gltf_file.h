#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

namespace morphbake {

/// A glTF file in memory: its JSON, its buffers. Opaque; gltf/ alone looks inside.
struct GltfDocument;

using GltfFile = std::shared_ptr<const GltfDocument>;

/// Opens a .glb or .gltf file with all its buffers.
///
/// Buffer and image URIs must stay inside the file's folder.
/// @throws BakeError "gltf.not-gltf", "gltf.truncated", "gltf.version", "gltf.invalid",
/// "gltf.outside-folder",
///         "gltf.unsupported-extension", "gltf.wrong-type", "gltf.missing-file",
///         "gltf.json-syntax", "gltf.json-duplicate-key", "gltf.json-too-deep"
GltfFile open_gltf(const std::filesystem::path& file);

/// Opens the bytes of a .glb that stands alone.
///
/// @param name  what messages call it
/// @throws BakeError as open_gltf
GltfFile open_gltf_bytes(std::string bytes, const std::filesystem::path& name);

/// The files beside a glTF that hold its buffers and images, whether they are there or not; none
/// where it is no glTF or cannot be read: opening it tells why.
std::vector<std::filesystem::path> files_beside(const std::filesystem::path& file);

/// Where the file was read from.
std::string file_of(const GltfFile& file);

}  // namespace morphbake
