#pragma once

// Internal to gltf/: the bytes that a glTF's JSON names, in the file itself, in data URIs and in
// files beside it.

#include <string>
#include <string_view>
#include <vector>

#include "morphbake/gltf/document.h"

namespace morphbake {

std::string_view as_text(const Bytes& bytes);

/// Reads all buffers: `byteLength` bytes each, or none of one that only stands in for what
/// EXT_meshopt_compression holds.
///
/// @param document  its JSON, checked
/// @param binary    the binary chunk of `document.glb`
/// @throws BakeError "gltf.invalid", "gltf.missing-file"
void read_buffers(GltfDocument& document, std::string_view binary);

/// The images, of which `mimeType` is what they are. Those that have a URI have bytes of their own.
///
/// @param document  its JSON, checked, and all of `model` but its images
/// @throws BakeError "gltf.invalid", "gltf.missing-file"
std::vector<tinygltf::Image> read_images(const GltfDocument& document);

/// The encoded bytes of an image, wherever they are.
std::string_view image_bytes(const GltfDocument& document, std::size_t image);

}  // namespace morphbake
