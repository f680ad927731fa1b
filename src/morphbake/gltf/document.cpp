#include "morphbake/gltf/document.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <utility>
#include <vector>

#include "morphbake/diagnostics/problem.h"
#include "morphbake/files/files.h"
#include "morphbake/gltf/animation_pointer.h"
#include "morphbake/gltf/check_document.h"
#include "morphbake/gltf/resources.h"
#include "morphbake/gltf/size_limits.h"
#include "morphbake/gltf/unpack.h"
#include "morphbake/gltf/uri.h"

namespace morphbake {
namespace fs = std::filesystem;

namespace {

// A .glb counts its bytes in 32 bits.
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

/// Makes whole numbers integers: JSON has one kind of number, and some exporters write an index as
/// 1.0. Nesting was bounded when the JSON was read.
void make_integers(Json& json) {
  constexpr double kExact = 9007199254740992;  // up to here doubles have all integers
  if (json.is_number_float()) {
    const double number = json.get<double>();
    if (number != std::floor(number) || std::abs(number) >= kExact) return;
    if (number < 0) {
      json = static_cast<std::int64_t>(number);
    } else {
      json = static_cast<std::uint64_t>(number);
    }
  } else if (json.is_array()) {
    for (Json& each : json) make_integers(each);
  } else if (json.is_object()) {
    for (auto& [name, value] : json.items()) {
      if (name != "extras") make_integers(value);
    }
  }
}

/// Broken JSON in a source is a problem of the source, not of the recipe: "json.syntax" is
/// "gltf.json-syntax".
Json parse_source_json(const GltfDocument& document, const std::string& text) {
  if (text.size() > kMostJsonBytes) {
    fail_at(document, "", "gltf.too-large",
            fmt::format("the JSON has {} bytes, more than {}", text.size(), kMostJsonBytes),
            "export a .glb, or a .gltf with its data in files beside it");
  }
  try {
    // Data URIs are long; no pattern is ever matched against them.
    const JsonLimits limits{text.size(), kMostJsonValues};
    Json json = parse_json(text, document.file.string(), limits);
    make_integers(json);
    return json;
  } catch (const BakeError& error) {
    std::vector<Problem> problems = error.problems();
    for (Problem& problem : problems) problem.code.replace(0, 5, "gltf.json-");
    throw BakeError(std::move(problems));
  }
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
  if (bytes.compare(at + 4, 4, "JSON") == 0) {
    fail_at(document, "", "gltf.invalid", "the .glb has two JSON chunks",
            "its exporter is at fault; export it again");
  }
  const bool is_bin = bytes.compare(at + 4, 4, std::string_view("BIN\0", 4)) == 0;
  return is_bin ? std::string_view(bytes).substr(at + kChunkHeader, length) : std::string_view();
}

/// Fields of a JSON while others stand in for them: each keeps its place.
class HiddenFields {
 public:
  HiddenFields() = default;
  HiddenFields(const HiddenFields&) = delete;
  HiddenFields& operator=(const HiddenFields&) = delete;

  ~HiddenFields() {
    for (auto& [field, value] : hidden_) *field = std::move(value);
  }

  void hide(Json& field, Json stand_in) {
    hidden_.emplace_back(&field, std::exchange(field, std::move(stand_in)));
  }

 private:
  std::vector<std::pair<Json*, Json>> hidden_;
};

/// Calls visit(mesh, primitive, its indices) for each primitive that has indices.
template <typename Visit>
void for_each_indices(Json& json, const Visit& visit) {
  const auto meshes = json.find("meshes");
  for (std::size_t m = 0; meshes != json.end() && m < meshes->size(); ++m) {
    Json& primitives = (*meshes)[m].at("primitives");
    for (std::size_t p = 0; p < primitives.size(); ++p) {
      const auto indices = primitives[p].find("indices");
      if (indices != primitives[p].end()) visit(m, p, *indices);
    }
  }
}

/// The JSON as text for tinygltf: without URIs, which it reads in its own way, without what we keep
/// and never look at, and without indices, which it wants to have a bufferView.
std::string text_for_parser(Json& json) {
  HiddenFields hidden;
  for (const char* name : {"buffers", "images", "samplers", "cameras", "extensions", "extras"}) {
    if (const auto found = json.find(name); found != json.end()) {
      hidden.hide(*found, Json::array());
    }
  }
  for_each_indices(json, [&](std::size_t, std::size_t, Json& at) { hidden.hide(at, -1); });
  return json.dump();
}

/// The JSON, typed: all but buffers, images and what text_for_parser leaves out.
tinygltf::Model parse_model(GltfDocument& document) {
  const std::string text = text_for_parser(document.json);
  tinygltf::Model model;
  std::string errors, warnings;
  if (!tinygltf::TinyGLTF().LoadASCIIFromString(&model, &errors, &warnings, text.data(),
                                                static_cast<unsigned int>(text.size()), "")) {
    std::replace(errors.begin(), errors.end(), '\n', ' ');
    errors.erase(errors.find_last_not_of(' ') + 1);
    fail_at(document, "", "gltf.invalid", fmt::format("this is no valid glTF: {}", errors),
            "the Khronos glTF validator lists what is wrong with a file");
  }
  for_each_indices(document.json, [&](std::size_t mesh, std::size_t primitive, const Json& at) {
    model.meshes[mesh].primitives[primitive].indices =
        static_cast<int>(std::min<std::uint64_t>(at.get<std::uint64_t>(), INT32_MAX));
  });
  return model;
}

/// Replaces compressed geometry by the same uncompressed.
void unpack(GltfDocument& document) {
  document.glb = unpacked_glb(document);
  document.named.clear();
  for (const char* list : {"accessors", "bufferViews", "extensionsUsed"}) {
    const auto found = document.json.find(list);
    if (found != document.json.end()) document.packed[list] = std::move(*found);
  }
  document.json = parse_source_json(document, json_chunk(document, document.glb));
  document.buffers.clear();
  const std::string_view binary = binary_chunk(document, document.glb);
  if (!binary.empty()) document.buffers.push_back(binary);
}

}  // namespace

void fail_at(const GltfDocument& document, const std::string& pointer, const std::string& code,
             const std::string& message, const std::string& hint) {
  throw BakeError(
      Problem{Severity::Error, code, {document.file.string(), pointer, 0, 0}, message, hint});
}

std::vector<fs::path> files_beside(const fs::path& file) {
  std::vector<fs::path> files;
  try {
    GltfDocument document;
    document.file = file;
    const std::string bytes = read_file(file, kFileSizeLimit);
    const Json json =
        parse_source_json(document, is_binary(bytes) ? json_chunk(document, bytes) : bytes);
    for (const char* list : {"buffers", "images"}) {
      for (const Json& entry : json.value(list, Json::array())) {
        const std::string uri = entry.value("uri", "");
        if (uri.empty() || is_data_uri(uri)) continue;
        const fs::path named = inside_folder(file.parent_path(), uri_path(uri));
        if (!named.empty()) files.push_back(named);
      }
    }
  } catch (const BakeError&) {
    return {};
  } catch (const Json::exception&) {
    return {};
  }
  return files;
}

std::string file_of(const GltfFile& file) { return file->file.string(); }

GltfFile open_gltf(const fs::path& file) {
  return open_gltf_bytes(read_file(file, kFileSizeLimit), file);
}

GltfFile open_gltf_bytes(std::string bytes, const fs::path& name) {
  auto document = std::make_shared<GltfDocument>();
  document->file = name;
  if (bytes.starts_with("\xEF\xBB\xBF")) {
    fail_at(*document, "", "gltf.not-gltf", "the file begins with a byte order mark",
            "JSON has none: save it as UTF-8 without");
  }
  const std::size_t first = bytes.find_first_not_of(" \t\r\n");
  if (!is_binary(bytes) && (first == std::string::npos || bytes[first] != '{')) {
    fail_at(*document, "", "gltf.not-gltf", "this is neither a .glb nor the JSON of a .gltf",
            "sources are glTF 2.0 files; export the mesh as .glb");
  }
  document->json =
      parse_source_json(*document, is_binary(bytes) ? json_chunk(*document, bytes) : bytes);
  check_document(*document, bytes.size());
  if (is_binary(bytes)) document->glb = std::move(bytes);
  read_buffers(*document, binary_chunk(*document, document->glb));
  if (is_packed(document->json)) unpack(*document);
  document->model = parse_model(*document);
  follow_pointers(*document);
  document->model.images = read_images(*document);
  return document;
}

}  // namespace morphbake
