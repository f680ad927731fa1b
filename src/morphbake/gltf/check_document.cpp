#include "morphbake/gltf/check_document.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <filesystem>

#include "morphbake/diagnostics/problem.h"
#include "morphbake/files/files.h"
#include "morphbake/gltf/check_references.h"
#include "morphbake/gltf/size_limits.h"
#include "morphbake/gltf/uri.h"
#include "morphbake/json/explain.h"
#include "morphbake/json/schema.h"

namespace morphbake {
namespace fs = std::filesystem;

namespace {

// What a source may require and still be read right: forms that are read, and what changes how a
// surface looks, not its shape.
constexpr std::array kReadableExtensions = {"KHR_mesh_quantization",
                                            "KHR_draco_mesh_compression",
                                            "EXT_meshopt_compression",
                                            "KHR_texture_transform",
                                            "KHR_texture_basisu",
                                            "EXT_texture_webp",
                                            "EXT_texture_avif",
                                            "MSFT_texture_dds",
                                            "KHR_materials_unlit",
                                            "KHR_materials_clearcoat",
                                            "KHR_materials_emissive_strength",
                                            "KHR_materials_ior",
                                            "KHR_materials_sheen",
                                            "KHR_materials_specular",
                                            "KHR_materials_pbrSpecularGlossiness",
                                            "KHR_materials_transmission",
                                            "KHR_materials_volume",
                                            "KHR_materials_iridescence",
                                            "KHR_materials_anisotropy",
                                            "KHR_materials_dispersion",
                                            "KHR_materials_diffuse_transmission",
                                            "KHR_materials_variants",
                                            "KHR_lights_punctual",
                                            "KHR_animation_pointer",
                                            "KHR_xmp_json_ld",
                                            "EXT_mesh_gpu_instancing",
                                            "EXT_lights_image_based"};

std::string array_pointer(const char* array, std::size_t index) {
  return fmt::format("/{}/{}", array, index);
}

void check_version(const GltfDocument& document) {
  const Json& json = document.json;
  const Json asset = json.is_object() ? json.value("asset", Json::object()) : Json();
  if (!asset.is_object() || !asset.contains("version")) {
    fail_at(document, "/asset/version", "gltf.not-gltf", "this JSON has no glTF asset version");
  }
  if (asset["version"] != "2.0") {
    fail_at(document, "/asset/version", "gltf.version",
            fmt::format("glTF version {} cannot be read", asset["version"].dump()),
            asset["version"] == 2.0 ? "the version is a string: \"2.0\""
                                    : "only glTF 2.0 can be read; convert the file");
  }
}

void check_required_extensions(const GltfDocument& document) {
  const auto required = document.json.find("extensionsRequired");
  if (required == document.json.end() || !required->is_array()) return;
  for (std::size_t i = 0; i < required->size(); ++i) {
    const std::string name = (*required)[i].is_string() ? (*required)[i].get<std::string>() : "";
    if (is_known_extension(name)) continue;
    fail_at(document, array_pointer("extensionsRequired", i), "gltf.unsupported-extension",
            fmt::format("the file requires the extension {}, which is not supported",
                        shown(Json(name))),
            "export it without that extension");
  }
}

/// Whether Linux can open no such file, as where data were meant.
bool is_too_long(const fs::path& file) {
  constexpr std::size_t kLongestPath = 4095, kLongestName = 255;
  return file.native().size() > kLongestPath || std::ranges::any_of(file, [](const fs::path& name) {
           return name.native().size() > kLongestName;
         });
}

/// Types and ranges, which tinygltf passes over in silence: a negative offset would be read as 0.
void check_fields(const GltfDocument& document) {
  static const Json schema = shipped_schema("gltf.schema.json");
  std::vector<Problem> problems =
      explain(document.json, schema, {document.file.string(), "", 0, 0});
  if (!problems.empty()) throw BakeError(std::move(problems));
}

/// Images have bytes: by a URI or in a bufferView.
void check_images(const GltfDocument& document) {
  const auto images = document.json.find("images");
  for (std::size_t i = 0; images != document.json.end() && i < images->size(); ++i) {
    const Json& image = (*images)[i];
    const std::string pointer = array_pointer("images", i);
    if (image.contains("uri")) {
      if (!image.contains("bufferView")) continue;
      fail_at(document, pointer, "gltf.invalid", "the image has both uri and bufferView");
    }
    if (!image.contains("bufferView")) {
      fail_at(document, pointer, "gltf.invalid", "the image has neither uri nor bufferView");
    }
  }
}

/// bufferViews lie in their buffers.
void check_views(const GltfDocument& document) {
  const Json& json = document.json;
  const auto views = json.find("bufferViews");
  if (views == json.end() || views->empty()) return;
  const Json& buffers = json.at("buffers");
  for (std::size_t v = 0; v < views->size(); ++v) {
    const Json& view = (*views)[v];
    if (view.value("byteStride", 4) % 4 != 0) {
      fail_at(document, array_pointer("bufferViews", v) + "/byteStride", "gltf.invalid",
              fmt::format("byteStride is {}, not a multiple of 4", view["byteStride"].dump()));
    }
    const auto buffer = view.at("buffer").get<std::size_t>();
    // Each is below 2^32: the sum cannot overflow.
    const std::size_t end =
        view.value("byteOffset", std::size_t{0}) + view.at("byteLength").get<std::size_t>();
    const auto size = buffers[buffer].at("byteLength").get<std::size_t>();
    if (end <= size) continue;
    fail_at(
        document, array_pointer("bufferViews", v), "gltf.invalid",
        fmt::format("the bufferView ends at byte {} of buffer {}, which has {}", end, buffer, size),
        "the file was cut off or its exporter is at fault; export it again");
  }
}

void check_uris(const GltfDocument& document, const char* array) {
  const auto items = document.json.find(array);
  if (items == document.json.end() || !items->is_array()) return;
  for (std::size_t i = 0; i < items->size(); ++i) {
    const Json& item = (*items)[i];
    if (!item.is_object() || !item.contains("uri") || !item["uri"].is_string()) continue;
    const std::string uri = item["uri"];
    if (is_data_uri(uri)) continue;
    const std::string pointer = array_pointer(array, i) + "/uri";
    if (is_too_long(uri_path(uri))) {
      fail_at(document, pointer, "gltf.missing-file",
              fmt::format("the URI has {} characters: no file has such a long name", uri.size()),
              "data in a URI begin with \"data:\"");
    }
    const fs::path target = inside_folder(document.file.parent_path(), uri_path(uri));
    if (target.empty()) {
      fail_at(document, pointer, "gltf.outside-folder",
              fmt::format("the URI \"{}\" leaves the folder of the glTF", uri),
              "put the file beside the glTF and name it by a relative path");
    }
    std::error_code error;
    if (!fs::is_regular_file(target, error)) {
      fail_at(document, pointer, "gltf.missing-file", fmt::format("there is no file \"{}\"", uri),
              "a .gltf needs its .bin and textures beside it; a .glb holds everything");
    }
  }
}

}  // namespace

bool is_known_extension(std::string_view name) {
  return std::find(kReadableExtensions.begin(), kReadableExtensions.end(), name) !=
         kReadableExtensions.end();
}

void check_document(const GltfDocument& document, std::size_t file_bytes) {
  check_version(document);
  check_text_size(document);
  check_list_sizes(document);
  check_fields(document);
  check_required_extensions(document);
  check_references(document);
  check_uris(document, "buffers");
  check_uris(document, "images");
  check_views(document);
  check_images(document);
  check_buffer_sizes(document, file_bytes);
}

}  // namespace morphbake
