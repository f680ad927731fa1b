#include "morphbake/gltf/media_type.h"

#include <algorithm>
#include <cctype>
#include <filesystem>

namespace morphbake {
namespace {

/// A kind of picture: the specification's, and those of extensions.
struct Kind {
  std::string_view media_type;
  std::string_view ending;
  std::string_view begin;  ///< of the bytes
  std::size_t at = 0;      ///< where `mark` stands
  std::string_view mark;   ///< or ""
};

// AVIF: an ISO file of the brand "avif", or "avis" for several pictures.
constexpr Kind kKinds[] = {
    {"image/png", ".png", "\x89PNG", 0, ""},          {"image/jpeg", ".jpg", "\xFF\xD8\xFF", 0, ""},
    {"image/jpeg", ".jpeg", "\xFF\xD8\xFF", 0, ""},   {"image/webp", ".webp", "RIFF", 8, "WEBP"},
    {"image/ktx2", ".ktx2", "\xABKTX 20\xBB", 0, ""}, {"image/vnd-ms.dds", ".dds", "DDS ", 0, ""},
    {"image/avif", ".avif", "", 4, "ftypavif"},       {"image/avif", ".avif", "", 4, "ftypavis"}};

bool begins_as(std::string_view bytes, const Kind& kind) {
  return bytes.size() >= kind.at && bytes.starts_with(kind.begin) &&
         bytes.substr(kind.at).starts_with(kind.mark);
}

}  // namespace

std::string media_type(std::string_view bytes, const ImageLabels& labels) {
  for (const Kind& kind : kKinds) {
    if (begins_as(bytes, kind)) return std::string(kind.media_type);
  }
  for (const std::string_view label : {labels.mime_type, labels.of_data}) {
    if (!label.empty()) return std::string(label);
  }
  std::string ending = std::filesystem::path(labels.path).extension().string();
  std::ranges::transform(ending, ending.begin(), [](unsigned char c) { return std::tolower(c); });
  for (const Kind& kind : kKinds) {
    if (ending == kind.ending) return std::string(kind.media_type);
  }
  return "application/octet-stream";
}

}  // namespace morphbake
