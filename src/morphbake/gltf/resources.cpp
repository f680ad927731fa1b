#include "morphbake/gltf/resources.h"

#include <fmt/core.h>

#include <filesystem>
#include <utility>

#include "morphbake/diagnostics/problem.h"
#include "morphbake/files/files.h"
#include "morphbake/gltf/media_type.h"
#include "morphbake/gltf/packed_parts.h"
#include "morphbake/gltf/uri.h"
#include "morphbake/images/images.h"

namespace morphbake {
namespace {

/// What a URI names.
struct Resource {
  Bytes bytes;
  std::string media_type;  ///< that a data URI says
};

/// What is read of a file.
struct Extent {
  std::size_t most = 0;   ///< bytes
  bool is_whole = false;  ///< or it is an error; else the file may be longer
};

Bytes file_bytes(const GltfDocument& document, const std::string& uri, const Extent& extent,
                 const std::string& pointer) {
  try {
    const auto file = inside_folder(document.file.parent_path(), uri_path(uri));
    const std::string bytes =
        extent.is_whole ? read_file(file, extent.most) : read_file_start(file, extent.most);
    return {bytes.begin(), bytes.end()};
  } catch (const BakeError& error) {
    const Problem& problem = error.problems().front();
    if (problem.code == "files.too-large") {
      fail_at(document, pointer, "gltf.too-large",
              fmt::format("the file \"{}\": {}", uri, problem.message), "use a smaller image");
    }
    fail_at(document, pointer, "gltf.missing-file",
            fmt::format("the file \"{}\": {}", uri, problem.message));
  }
}

/// @param pointer  of the URI
Resource read_uri(const GltfDocument& document, const std::string& uri, const Extent& extent,
                  const std::string& pointer) {
  if (!is_data_uri(uri)) return {file_bytes(document, uri, extent, pointer), ""};
  DataUri data = read_data_uri(uri);
  if (!data.fault.empty()) {
    fail_at(document, pointer, "gltf.invalid",
            fmt::format("the data URI cannot be read: {}", data.fault), "export the file again");
  }
  return {std::move(data.bytes), std::move(data.media_type)};
}

/// Whether it is a compressed bufferView, or a buffer that has bytes for such only.
bool has_meshopt(const Json& item) {
  const auto extensions = item.find("extensions");
  return extensions != item.end() && extensions->contains(kMeshopt);
}

/// The bytes of a buffer, of which there may be more than its byteLength.
///
/// @param binary  the chunk that is this buffer's when it has no URI
std::string_view buffer_bytes(GltfDocument& document, const Json& buffer, std::string_view binary,
                              const std::string& pointer) {
  const auto uri = buffer.find("uri");
  if (uri == buffer.end()) return binary;
  const auto size = buffer.at("byteLength").get<std::size_t>();
  Resource resource =
      read_uri(document, uri->get_ref<const std::string&>(), {size}, pointer + "/uri");
  return as_text(document.named.emplace_back(std::move(resource.bytes)));
}

/// Where a buffer has no bytes of its own, all its bufferViews are compressed.
void check_fallback_views(const GltfDocument& document) {
  const auto views = document.json.find("bufferViews");
  for (std::size_t v = 0; views != document.json.end() && v < views->size(); ++v) {
    const Json& view = (*views)[v];
    const bool is_empty = document.buffers[view.at("buffer").get<std::size_t>()].empty();
    if (!is_empty || view.at("byteLength") == 0 || has_meshopt(view)) continue;
    fail_at(document, fmt::format("/bufferViews/{}", v), "gltf.invalid",
            fmt::format("buffer {} has no bytes, and the bufferView is not compressed",
                        view.at("buffer").dump()));
  }
}

/// The bytes of a bufferView that check_document saw inside its buffer.
std::string_view view_bytes(const GltfDocument& document, int index) {
  const tinygltf::BufferView& view = document.model.bufferViews[static_cast<std::size_t>(index)];
  return document.buffers[static_cast<std::size_t>(view.buffer)].substr(view.byteOffset,
                                                                        view.byteLength);
}

}  // namespace

std::string_view as_text(const Bytes& bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

void read_buffers(GltfDocument& document, std::string_view binary) {
  const auto found = document.json.find("buffers");
  for (std::size_t b = 0; found != document.json.end() && b < found->size(); ++b) {
    const Json& buffer = (*found)[b];
    const std::string pointer = fmt::format("/buffers/{}", b);
    const auto size = buffer.at("byteLength").get<std::size_t>();
    const std::string_view bytes =
        buffer_bytes(document, buffer, b == 0 ? binary : std::string_view(), pointer)
            .substr(0, size);
    document.buffers.push_back(bytes);
    const bool may_be_empty = has_meshopt(buffer) && bytes.empty();
    if (bytes.size() == size || may_be_empty) continue;
    fail_at(document, pointer, "gltf.invalid",
            fmt::format("the buffer has {} bytes where byteLength says {}", bytes.size(), size),
            "the file was cut off or its exporter is at fault; export it again");
  }
  check_fallback_views(document);
}

std::vector<tinygltf::Image> read_images(const GltfDocument& document) {
  std::vector<tinygltf::Image> images;
  const auto found = document.json.find("images");
  for (std::size_t i = 0; found != document.json.end() && i < found->size(); ++i) {
    const Json& json = (*found)[i];
    const std::string pointer = fmt::format("/images/{}", i);
    tinygltf::Image& image = images.emplace_back();
    std::string path, of_data;
    if (const auto uri = json.find("uri"); uri != json.end()) {
      const auto& text = uri->get_ref<const std::string&>();
      Resource resource = read_uri(document, text, {kMostImageBytes, true}, pointer + "/uri");
      image.image = std::move(resource.bytes);
      of_data = std::move(resource.media_type);
      if (!is_data_uri(text)) path = uri_path(text);
    } else {
      image.bufferView = json.at("bufferView").get<int>();
    }
    const std::string_view bytes =
        image.bufferView < 0 ? as_text(image.image) : view_bytes(document, image.bufferView);
    if (bytes.empty()) fail_at(document, pointer, "gltf.invalid", "the image has no bytes");
    image.mimeType = media_type(bytes, {json.value("mimeType", std::string()), of_data, path});
  }
  return images;
}

std::string_view image_bytes(const GltfDocument& document, std::size_t index) {
  const tinygltf::Image& image = document.model.images[index];
  return image.bufferView < 0 ? as_text(image.image) : view_bytes(document, image.bufferView);
}

}  // namespace morphbake
