#pragma once

// Internal to gltf/: what a GltfFile holds.

// Images are kept as they are: tinygltf's own coders are not compiled in.
#define TINYGLTF_NO_STB_IMAGE
#define TINYGLTF_NO_STB_IMAGE_WRITE
#include <tiny_gltf.h>

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "morphbake/gltf/gltf_file.h"
#include "morphbake/json/json.h"

namespace morphbake {

using Bytes = std::vector<unsigned char>;

struct GltfDocument {
  std::filesystem::path file;
  Json json;    ///< as in the file: what is kept is kept from here
  Json packed;  ///< accessors, bufferViews, extensionsUsed before geometry was unpacked; else null
  tinygltf::Model model;                  ///< the same, typed, with images but without buffers
  std::string glb;                        ///< the file's bytes, or those that it was unpacked to
  std::vector<Bytes> named;               ///< of the buffers that have a URI
  std::vector<std::string_view> buffers;  ///< bytes of all of them, in `glb` or `named`
};

/// @throws BakeError `code` at `pointer` of the glTF's JSON
[[noreturn]] void fail_at(const GltfDocument& document, const std::string& pointer,
                          const std::string& code, const std::string& message,
                          const std::string& hint = {});

}  // namespace morphbake
