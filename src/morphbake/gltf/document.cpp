#include "morphbake/gltf/document.h"

#include <fmt/core.h>

#include <algorithm>
#include <charconv>
#include <cstdint>
#include <cstring>

#include "morphbake/diagnostics/problem.h"
#include "morphbake/files/files.h"
#include "morphbake/gltf/check_document.h"
#include "morphbake/gltf/size_limits.h"
#include "morphbake/gltf/unpack.h"

namespace morphbake {
namespace fs = std::filesystem;

namespace {

// tinygltf counts bytes in 32 bits.
constexpr std::uintmax_t kFileSizeLimit = (std::uintmax_t{1} << 32) - 1;

std::uint32_t read_u32(const std::string& bytes, std::size_t offset) {
  std::uint32_t value = 0;
  std::memcpy(&value, bytes.data() + offset, sizeof value);  // GLB and this machine: little-endian
  return value;
}

bool is_binary(const std::string& bytes) { return bytes.compare(0, 4, "glTF") == 0; }

/// The JSON chunk of a .glb, after checking its header.
std::string json_chunk(const GltfDocument& document, const std::string& bytes) {
  constexpr std::size_t kHeader = 12, kChunkHeader = 8;
  if (bytes.size() < kHeader + kChunkHeader) {
    fail_at(document, "", "gltf.truncated",
            fmt::format("a .glb of {} bytes is no glTF", bytes.size()));
  }
  if (const std::uint32_t version = read_u32(bytes, 4); version != 2) {
    fail_at(document, "", "gltf.version", fmt::format("the .glb has container version {}", version),
            "only glTF 2.0 can be read");
  }
  if (const std::uint32_t length = read_u32(bytes, 8); length != bytes.size()) {
    fail_at(document, "", "gltf.truncated",
            fmt::format("the .glb says that it has {} bytes but has {}", length, bytes.size()),
            "the file was cut off or damaged; export or copy it again");
  }
  const std::uint32_t length = read_u32(bytes, kHeader);
  if (length > bytes.size() - kHeader - kChunkHeader || bytes.compare(16, 4, "JSON") != 0) {
    fail_at(document, "", "gltf.truncated",
            "the first chunk of the .glb is no complete JSON chunk");
  }
  return bytes.substr(kHeader + kChunkHeader, length);
}

/// Broken JSON in a source is a problem of the source, not of the recipe: "json.syntax" is
/// "gltf.json-syntax".
Json parse_source_json(const GltfDocument& document, const std::string& text) {
  try {
    // Data URIs are long; no pattern is ever matched against them.
    const JsonLimits limits{text.size(), kMostJsonValues};
    return parse_json(text, document.file.string(), limits);
  } catch (const BakeError& error) {
    std::vector<Problem> problems = error.problems();
    for (Problem& problem : problems) problem.code.replace(0, 5, "gltf.json-");
    throw BakeError(std::move(problems));
  }
}

bool file_exists(const std::string& name, void* user) {
  const auto& folder = *static_cast<const fs::path*>(user);
  return !inside_folder(folder, name).empty();
}

std::string same_path(const std::string& name, void*) { return name; }

bool read_whole_file(std::vector<unsigned char>* out, std::string* error, const std::string& name,
                     void* user) {
  const auto& folder = *static_cast<const fs::path*>(user);
  try {
    const std::string bytes = read_file(inside_folder(folder, name), kFileSizeLimit);
    out->assign(bytes.begin(), bytes.end());
    return true;
  } catch (const BakeError& missing) {
    *error = missing.what();
    return false;
  }
}

/// Images are kept as the bytes they are; nothing is decoded here.
// NOLINTNEXTLINE(readability-function-size): tinygltf says which parameters
bool keep_image(tinygltf::Image* image, int, std::string*, std::string*, int, int,
                const unsigned char* bytes, int size, void*) {
  image->as_is = true;
  image->image.assign(bytes, bytes + size);
  return true;
}

/// The binary chunk of a .glb whose JSON chunk was checked, or nothing.
std::string_view binary_chunk(const GltfDocument& document, const std::string& bytes) {
  constexpr std::size_t kHeader = 12, kChunkHeader = 8;
  if (!is_binary(bytes)) return {};
  const std::size_t at = kHeader + kChunkHeader + read_u32(bytes, kHeader);
  if (at + kChunkHeader > bytes.size()) return {};
  const std::uint32_t length = read_u32(bytes, at);
  if (length > bytes.size() - at - kChunkHeader) {
    fail_at(document, "", "gltf.truncated",
            fmt::format("the second chunk of the .glb says that it has {} bytes, but {} follow",
                        length, bytes.size() - at - kChunkHeader),
            "the file was cut off or damaged; export or copy it again");
  }
  const bool is_bin = bytes.compare(at + 4, 4, std::string_view("BIN\0", 4)) == 0;
  return is_bin ? std::string_view(bytes).substr(at + kChunkHeader, length) : std::string_view();
}

/// The bytes of a buffer that has a URI.
std::string uri_bytes(const GltfDocument& document, const std::string& uri, std::size_t index) {
  if (!uri.starts_with("data:")) {
    const fs::path folder = document.file.parent_path();
    return read_file(inside_folder(folder, uri_path(uri)), kFileSizeLimit);
  }
  std::vector<unsigned char> bytes;
  std::string mime_type;
  if (!tinygltf::DecodeDataURI(&bytes, mime_type, uri, 0, false)) {
    fail_at(document, fmt::format("/buffers/{}/uri", index), "gltf.invalid",
            "the data URI cannot be decoded");
  }
  return {bytes.begin(), bytes.end()};
}

/// The bytes of all buffers; none of one that only stands in for what is compressed.
std::vector<std::string> buffers_of(const GltfDocument& document, std::string_view binary) {
  std::vector<std::string> buffers;
  const auto found = document.json.find("buffers");
  for (std::size_t b = 0; found != document.json.end() && b < found->size(); ++b) {
    const Json& buffer = (*found)[b];
    std::string content;
    if (buffer.contains("uri")) {
      content = uri_bytes(document, buffer["uri"].get<std::string>(), b);
    } else if (b == 0) {
      content = binary;
    }
    const auto size = buffer.at("byteLength").get<std::size_t>();
    if (content.size() > size) content.resize(size);
    buffers.push_back(std::move(content));
  }
  return buffers;
}

void parse_model(GltfDocument& document, const std::string& bytes) {
  fs::path folder = document.file.parent_path();
  tinygltf::TinyGLTF parser;
  parser.SetFsCallbacks({file_exists, same_path, read_whole_file, nullptr, &folder});
  parser.SetImageLoader(keep_image, nullptr);
  std::string errors, warnings;
  const auto size = static_cast<unsigned int>(bytes.size());
  const bool parsed =
      is_binary(bytes)
          ? parser.LoadBinaryFromMemory(&document.model, &errors, &warnings,
                                        reinterpret_cast<const unsigned char*>(bytes.data()), size,
                                        "")
          : parser.LoadASCIIFromString(&document.model, &errors, &warnings, bytes.data(), size, "");
  if (parsed) return;
  std::replace(errors.begin(), errors.end(), '\n', ' ');
  errors.erase(errors.find_last_not_of(' ') + 1);
  fail_at(document, "", "gltf.invalid", fmt::format("this is no valid glTF: {}", errors),
          "the Khronos glTF validator lists what is wrong with a file");
}

}  // namespace

std::string uri_path(const std::string& uri) {
  std::string text;
  for (std::size_t i = 0; i < uri.size(); ++i) {
    unsigned value = 0;
    const char* digits = uri.data() + i + 1;
    const bool escaped = uri[i] == '%' && i + 2 < uri.size() &&
                         std::from_chars(digits, digits + 2, value, 16).ptr == digits + 2;
    text += escaped ? static_cast<char>(value) : uri[i];
    if (escaped) i += 2;
  }
  return text;
}

void fail_at(const GltfDocument& document, const std::string& pointer, const std::string& code,
             const std::string& message, const std::string& hint) {
  throw BakeError(
      Problem{Severity::Error, code, {document.file.string(), pointer, 0, 0}, message, hint});
}

std::string file_of(const GltfFile& file) { return file->file.string(); }

GltfFile open_gltf(const fs::path& file) {
  return open_gltf_bytes(read_file(file, kFileSizeLimit), file);
}

GltfFile open_gltf_bytes(const std::string& bytes, const fs::path& name) {
  auto document = std::make_shared<GltfDocument>();
  document->file = name;
  const std::size_t first = bytes.find_first_not_of(" \t\r\n");
  if (!is_binary(bytes) && (first == std::string::npos || bytes[first] != '{')) {
    fail_at(*document, "", "gltf.not-gltf", "this is neither a .glb nor the JSON of a .gltf",
            "sources are glTF 2.0 files; export the mesh as .glb");
  }
  document->json =
      parse_source_json(*document, is_binary(bytes) ? json_chunk(*document, bytes) : bytes);
  check_document(*document, bytes.size());
  const std::string_view binary = binary_chunk(*document, bytes);
  if (is_packed(document->json)) {
    const std::string unpacked = unpacked_glb(*document, buffers_of(*document, binary));
    document->json = parse_source_json(*document, json_chunk(*document, unpacked));
    parse_model(*document, unpacked);
  } else {
    parse_model(*document, bytes);
  }
  return document;
}

}  // namespace morphbake
