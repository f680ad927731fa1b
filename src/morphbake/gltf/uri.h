#pragma once

// Internal to gltf/: what stands in "uri" of buffers and images.

#include <string>
#include <string_view>
#include <vector>

namespace morphbake {

/// The relative path that a URI names: its percent-encoding removed.
std::string uri_path(const std::string& uri);

/// Whether the bytes stand in the URI itself (RFC 2397).
bool is_data_uri(std::string_view uri);

/// What stands in a data URI.
struct DataUri {
  std::vector<unsigned char> bytes;
  std::string media_type;  ///< in lower case, without parameters: "image/png"; "" when it says none
  std::string fault;       ///< what is wrong with it, or "": then the rest holds
};

/// Reads `data:[media type][;parameter ...][;base64],data`. The data may be percent-encoded, in
/// base64 too, whose padding may be left out. Anything else that neither is, is a fault.
///
/// @param uri  for which is_data_uri
DataUri read_data_uri(std::string_view uri);

}  // namespace morphbake
