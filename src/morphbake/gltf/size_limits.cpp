#include "morphbake/gltf/size_limits.h"

#include <fmt/core.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <string>

#include "morphbake/gltf/source_geometry.h"
#include "morphbake/gltf/uri.h"

namespace morphbake {
namespace {

// Of vertices and indices, each of which takes some hundred bytes until a mesh is welded.
constexpr std::size_t kFewestElements = std::size_t{1} << 22;
// Of three floats, which are only kept: 200 MB.
constexpr std::size_t kFewestRows = std::size_t{1} << 24;
constexpr std::size_t kRowsOfJoints = 6;  // four joints and weights, as they are read and as kept

constexpr std::size_t kMostText = std::size_t{1} << 26;  // each is held up to eight times over
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

using Attributes = std::map<std::string, int>;

/// What a primitive asks for.
struct MeshSize {
  std::size_t elements = 0;  ///< vertices and indices
  std::size_t rows = 0;      ///< of three numbers each
};

std::size_t buffer_bytes(const GltfDocument& document) {
  std::size_t bytes = 0;
  for (const std::string_view buffer : document.buffers) bytes += buffer.size();
  return bytes;
}

/// A list, or an empty one: objects find their fields one by one, so each list is looked up once.
const Json& list_of(const Json& owner, const char* list) {
  static const Json none = Json::array();
  if (!owner.is_object()) return none;
  const auto found = owner.find(list);
  return found != owner.end() && found->is_array() ? *found : none;
}

std::size_t length_of(const Json& owner, const char* list) { return list_of(owner, list).size(); }

/// Entries of the lists that are in the entries of a list.
std::size_t length_within(const Json& json, const char* outer, const char* inner) {
  std::size_t length = 0;
  for (const Json& owner : list_of(json, outer)) length += length_of(owner, inner);
  return length;
}

/// Bytes of all names and strings; nesting was bounded when the JSON was read.
std::size_t text_bytes(const Json& json) {
  if (json.is_string()) return json.get_ref<const std::string&>().size();
  std::size_t bytes = 0;
  if (json.is_object()) {
    for (const auto& [name, value] : json.items()) bytes += name.size() + text_bytes(value);
  } else if (json.is_array()) {
    for (const Json& value : json) bytes += text_bytes(value);
  }
  return bytes;
}

std::size_t uri_bytes(const Json& json, const char* list) {
  std::size_t bytes = 0;
  for (const Json& item : list_of(json, list)) {
    if (item.is_object() && item.contains("uri")) bytes += text_bytes(item["uri"]);
  }
  return bytes;
}

MeshSize mesh_size(const GltfDocument& document, const tinygltf::Primitive& primitive) {
  MeshSize size;
  const auto count = [&](const Attributes& attributes, const std::string& name) {
    const auto found = attributes.find(name);
    return found == attributes.end() ? 0 : elements_of(document, found->second);
  };
  size.elements =
      elements_of(document, primitive.indices) + count(primitive.attributes, "POSITION");
  for (const auto& target : primitive.targets) {
    size.rows += count(target, "POSITION") + count(target, "NORMAL");
  }
  for (std::size_t set = 0;; ++set) {
    const auto joints = primitive.attributes.find(fmt::format("JOINTS_{}", set));
    if (joints == primitive.attributes.end()) return size;
    size.rows += kRowsOfJoints * elements_of(document, joints->second);
  }
}

/// @param pointer  of the primitive that is too much
[[noreturn]] void refuse_mesh(const GltfDocument& document, const std::string& pointer,
                              const MeshSize& size, const MeshSize& limit) {
  const bool are_rows = size.elements <= limit.elements;
  fail_at(document, pointer, "gltf.too-large",
          fmt::format(
              "the mesh asks for more than {} {}, out of {} bytes",
              are_rows ? limit.rows : limit.elements,
              are_rows ? "rows of targets and joints together" : "vertices and indices together",
              buffer_bytes(document)),
          "primitives or targets that share one long accessor need one of their own each");
}

}  // namespace

void check_text_size(const GltfDocument& document) {
  const Json& json = document.json;
  const std::size_t bytes =
      text_bytes(json) - uri_bytes(json, "buffers") - uri_bytes(json, "images");
  if (bytes <= kMostText) return;
  fail_at(document, "", "gltf.too-large",
          fmt::format("the JSON has {} bytes of names and strings, more than {}", bytes, kMostText),
          "put data into a buffer, or beside the file");
}

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
      {length_of(json, "buffers"), sizeof(Bytes) + sizeof(std::string_view)},
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
  // Of a buffer's file its byteLength is read, of an image's all.
  const auto add = [&](const Json& item) {
    const auto uri = item.find("uri");
    if (uri == item.end() || is_data_uri(uri->get_ref<const std::string&>())) return;
    const std::filesystem::path file =
        document.file.parent_path() / uri_path(uri->get_ref<const std::string&>());
    std::error_code error;
    std::uintmax_t size = std::filesystem::file_size(file, error);
    if (error) return;  // told where it is opened
    if (named.emplace(file.lexically_normal().string(), size).second) bytes += size;
    const auto length = item.find("byteLength");
    if (length != item.end() && length->is_number()) {
      size = std::min<std::uintmax_t>(size, length->get<std::uintmax_t>());
    }
    asked += size;
  };
  for (const Json& buffer : list_of(document.json, "buffers")) add(buffer);
  const Json& views = list_of(document.json, "bufferViews");
  for (const Json& image : list_of(document.json, "images")) {
    add(image);
    const auto view = image.find("bufferView");
    if (view == image.end()) continue;
    asked += views[view->get<std::size_t>()]["byteLength"].get<std::size_t>();
  }
  if (asked <= 2 * bytes + kSpareBytes) return;
  fail_at(document, "", "gltf.too-large",
          fmt::format("buffers and images name the same bytes again and again: {} out of {}", asked,
                      bytes),
          "let textures share one image");
}

std::size_t most_curve_numbers(const GltfDocument& document) {
  // A key of an own sampler has at least a byte a number; its time may be that of many samplers.
  return std::max(2 * buffer_bytes(document), kFewestRows);
}

void check_mesh_size(const GltfDocument& document, int mesh) { check_mesh_sizes(document, {mesh}); }

void check_mesh_sizes(const GltfDocument& document, const std::vector<int>& meshes) {
  const std::size_t bytes = buffer_bytes(document);
  const MeshSize limit{std::max(bytes, kFewestElements), std::max(bytes, kFewestRows)};
  MeshSize size;
  for (const int mesh : meshes) {
    const auto& primitives = document.model.meshes[static_cast<std::size_t>(mesh)].primitives;
    for (std::size_t p = 0; p < primitives.size(); ++p) {
      const MeshSize added = mesh_size(document, primitives[p]);
      size.elements += added.elements;
      size.rows += added.rows;
      // Counts are below 2^32 each, and JSON has 2^21 values: with a test a primitive no overflow.
      if (size.elements <= limit.elements && size.rows <= limit.rows) continue;
      refuse_mesh(document, primitive_pointer(mesh, p), size, limit);
    }
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
