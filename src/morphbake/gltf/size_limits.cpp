#include "morphbake/gltf/size_limits.h"

#include <fmt/core.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <string>

#include "morphbake/gltf/source_geometry.h"

namespace morphbake {
namespace {

constexpr std::size_t kFewestElements = std::size_t{1} << 22;

constexpr std::size_t kMostListBytes = std::size_t{1} << 28;
constexpr std::size_t kSpareBytes = std::size_t{1} << 26;

constexpr std::size_t kUnpackedBytes = std::size_t{1} << 25;  // whatever the size of the file
constexpr std::size_t kMostUnpackedBytes = std::size_t{1} << 30;
constexpr std::size_t kUnpackedShare = 64;  // meshopt's own limit, of vertices that are all equal

std::size_t elements_of(const GltfDocument& document, int accessor) {
  const auto& accessors = document.model.accessors;
  const bool exists = accessor >= 0 && static_cast<std::size_t>(accessor) < accessors.size();
  return exists ? accessors[static_cast<std::size_t>(accessor)].count : 0;
}

/// Those of POSITION; other attributes have as many.
std::size_t positions_of(const GltfDocument& document,
                         const std::map<std::string, int>& attributes) {
  const auto position = attributes.find("POSITION");
  return position == attributes.end() ? 0 : elements_of(document, position->second);
}

/// Entries of a list, 0 when it is none.
std::size_t length_of(const Json& owner, const char* list) {
  if (!owner.is_object()) return 0;
  const auto found = owner.find(list);
  return found != owner.end() && found->is_array() ? found->size() : 0;
}

/// Entries of the lists that are in the entries of a list.
std::size_t length_within(const Json& json, const char* outer, const char* inner) {
  std::size_t length = 0;
  for (std::size_t i = 0; i < length_of(json, outer); ++i) {
    length += length_of(json[outer][i], inner);
  }
  return length;
}

}  // namespace

void check_list_sizes(const GltfDocument& document) {
  const Json& json = document.json;

  struct List {
    std::size_t length, bytes;
  };

  const List lists[] = {
      {length_of(json, "nodes"), sizeof(tinygltf::Node) + 2 * sizeof(Eigen::Matrix4d)},
      {length_of(json, "meshes"), sizeof(tinygltf::Mesh)},
      {length_within(json, "meshes", "primitives"), sizeof(tinygltf::Primitive)},
      {length_of(json, "accessors"), sizeof(tinygltf::Accessor)},
      {length_of(json, "bufferViews"), sizeof(tinygltf::BufferView)},
      {length_of(json, "buffers"), sizeof(tinygltf::Buffer)},
      {length_of(json, "images"), sizeof(tinygltf::Image)},
      {length_of(json, "materials"), sizeof(tinygltf::Material)},
      {length_of(json, "textures"), sizeof(tinygltf::Texture)},
      {length_of(json, "samplers"), sizeof(tinygltf::Sampler)},
      {length_of(json, "animations"), sizeof(tinygltf::Animation)},
      {length_within(json, "animations", "channels"), sizeof(tinygltf::AnimationChannel)},
      {length_within(json, "animations", "samplers"), sizeof(tinygltf::AnimationSampler)},
      {length_of(json, "skins"), sizeof(tinygltf::Skin)},
      {length_of(json, "cameras"), sizeof(tinygltf::Camera)},
      {length_of(json, "scenes"), sizeof(tinygltf::Scene)}};
  std::size_t bytes = 0, entries = 0;
  for (const List& list : lists) {
    bytes += list.length * list.bytes;
    entries += list.length;
  }
  if (bytes <= kMostListBytes) return;
  fail_at(document, "", "gltf.too-large",
          fmt::format("the file has {} nodes, meshes, accessors, materials and the like, more than "
                      "can be held",
                      entries),
          "export the mesh that is to be morphed alone");
}

void check_buffer_sizes(const GltfDocument& document, std::size_t file_bytes) {
  std::map<std::string, std::size_t> named;  // files beside the glTF, each once
  std::size_t bytes = file_bytes, asked = 0;
  const auto add = [&](const Json& item) {
    if (!item.contains("uri")) return;
    const auto& uri = item["uri"].get_ref<const std::string&>();
    if (uri.starts_with("data:")) return;
    const std::filesystem::path file = document.file.parent_path() / uri_path(uri);
    std::error_code error;
    const std::uintmax_t size = std::filesystem::file_size(file, error);
    if (error) return;  // told where it is opened
    asked += size;
    if (named.emplace(file.lexically_normal().string(), size).second) bytes += size;
  };
  for (const char* list : {"buffers", "images"}) {
    for (std::size_t i = 0; i < length_of(document.json, list); ++i) add(document.json[list][i]);
  }
  for (std::size_t i = 0; i < length_of(document.json, "images"); ++i) {
    const Json& image = document.json["images"][i];
    const auto view = image.find("bufferView");
    if (view == image.end() ||
        view->get<std::size_t>() >= length_of(document.json, "bufferViews")) {
      continue;
    }
    asked +=
        document.json["bufferViews"][view->get<std::size_t>()]["byteLength"].get<std::size_t>();
  }
  if (asked <= 2 * bytes + kSpareBytes) return;
  fail_at(document, "", "gltf.too-large",
          fmt::format("buffers and images name the same bytes again and again: {} out of {}", asked,
                      bytes),
          "let textures share one image");
}

void check_mesh_size(const GltfDocument& document, int mesh) {
  std::size_t bytes = 0;
  for (const tinygltf::Buffer& buffer : document.model.buffers) bytes += buffer.data.size();
  const std::size_t limit = std::max(bytes, kFewestElements);
  const auto& primitives = document.model.meshes[static_cast<std::size_t>(mesh)].primitives;
  std::size_t elements = 0;
  for (std::size_t p = 0; p < primitives.size(); ++p) {
    const tinygltf::Primitive& primitive = primitives[p];
    elements += elements_of(document, primitive.indices);
    elements += positions_of(document, primitive.attributes);
    for (const auto& target : primitive.targets) elements += positions_of(document, target);
    // Counts are below 2^32 each: with a test a primitive the sum cannot overflow.
    if (elements <= limit) continue;
    fail_at(document, primitive_pointer(mesh, p), "gltf.too-large",
            fmt::format("the mesh asks for more than {} vertices, indices and rows of targets "
                        "together, out of {} bytes",
                        limit, bytes),
            "primitives that share one long accessor need one of their own each");
  }
}

UnpackBudget UnpackBudget::of_file(std::size_t bytes) {
  const std::size_t share = std::min(bytes, kMostUnpackedBytes / kUnpackedShare) * kUnpackedShare;
  return {std::min(share + kUnpackedBytes, kMostUnpackedBytes)};
}

bool UnpackBudget::take(std::size_t bytes) {
  if (bytes > left) return false;
  left -= bytes;
  return true;
}

}  // namespace morphbake
