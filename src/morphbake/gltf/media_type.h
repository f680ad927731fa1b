#pragma once

// Internal to gltf/: what kind of picture an image is.

#include <string>
#include <string_view>

namespace morphbake {

/// What the file says of an image.
struct ImageLabels {
  std::string_view mime_type;  ///< of the image, or ""
  std::string_view of_data;    ///< of its data URI, or ""
  std::string_view path;       ///< of its file, or ""
};

/// "image/png" and the like: what the bytes begin as, else what the file says, else what the ending
/// of the path says. A bufferView's image needs one, so "application/octet-stream" when nothing
/// tells.
std::string media_type(std::string_view bytes, const ImageLabels& labels);

}  // namespace morphbake
