#include "morphbake/gltf/check_references.h"

#include <fmt/core.h>

#include <algorithm>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace morphbake {
namespace {

using Path = std::span<const std::string_view>;

/// Fields that hold indices into a list of the file.
struct Reference {
  std::string_view fields;  ///< keys; * is any
  const char* list;
  const char* kind;  ///< one of the list
};

constexpr Reference kReferences[] = {
    {"scene", "scenes", "scene"},
    {"scenes/*/nodes/*", "nodes", "node"},
    {"nodes/*/children/*", "nodes", "node"},
    {"nodes/*/mesh", "meshes", "mesh"},
    {"nodes/*/skin", "skins", "skin"},
    {"nodes/*/camera", "cameras", "camera"},
    {"skins/*/skeleton", "nodes", "node"},
    {"skins/*/joints/*", "nodes", "node"},
    {"skins/*/inverseBindMatrices", "accessors", "accessor"},
    {"meshes/*/primitives/*/material", "materials", "material"},
    {"meshes/*/primitives/*/indices", "accessors", "accessor"},
    {"meshes/*/primitives/*/attributes/*", "accessors", "accessor"},
    {"meshes/*/primitives/*/targets/*/*", "accessors", "accessor"},
    {"accessors/*/bufferView", "bufferViews", "bufferView"},
    {"accessors/*/sparse/indices/bufferView", "bufferViews", "bufferView"},
    {"accessors/*/sparse/values/bufferView", "bufferViews", "bufferView"},
    {"bufferViews/*/buffer", "buffers", "buffer"},
    {"bufferViews/*/extensions/EXT_meshopt_compression/buffer", "buffers", "buffer"},
    {"meshes/*/primitives/*/extensions/KHR_draco_mesh_compression/bufferView", "bufferViews",
     "bufferView"},
    {"images/*/bufferView", "bufferViews", "bufferView"},
    {"textures/*/source", "images", "image"},
    {"textures/*/extensions/KHR_texture_basisu/source", "images", "image"},
    {"textures/*/extensions/EXT_texture_webp/source", "images", "image"},
    {"textures/*/extensions/EXT_texture_avif/source", "images", "image"},
    {"textures/*/extensions/MSFT_texture_dds/source", "images", "image"},
    {"textures/*/sampler", "samplers", "sampler"},
    {"materials/*/pbrMetallicRoughness/baseColorTexture/index", "textures", "texture"},
    {"materials/*/pbrMetallicRoughness/metallicRoughnessTexture/index", "textures", "texture"},
    {"materials/*/normalTexture/index", "textures", "texture"},
    {"materials/*/occlusionTexture/index", "textures", "texture"},
    {"materials/*/emissiveTexture/index", "textures", "texture"},
    {"animations/*/channels/*/target/node", "nodes", "node"},
    {"animations/*/samplers/*/input", "accessors", "accessor"},
    {"animations/*/samplers/*/output", "accessors", "accessor"}};

std::vector<std::string_view> keys_of(std::string_view fields) {
  std::vector<std::string_view> keys;
  for (std::size_t begin = 0; begin <= fields.size();) {
    const std::size_t end = std::min(fields.find('/', begin), fields.size());
    keys.push_back(fields.substr(begin, end - begin));
    begin = end + 1;
  }
  return keys;
}

struct Dangling {
  Json::json_pointer at;
  std::string index;
};

/// Whether it is a number, and no index of `count` things.
bool is_beyond(const Json& value, std::size_t count) {
  if (!value.is_number_integer()) return false;
  return !value.is_number_unsigned() || value.get<std::uint64_t>() >= count;
}

/// The first number at `path` that is no index of `count` things.
std::optional<Dangling> find_dangling(const Json& value, Path path, std::size_t count) {
  if (path.empty()) {
    if (!is_beyond(value, count)) return std::nullopt;
    return Dangling{Json::json_pointer(), value.dump()};
  }
  const auto find_below = [&](const Json& below, auto key) {
    std::optional<Dangling> found = find_dangling(below, path.subspan(1), count);
    if (found) found->at = Json::json_pointer() / std::move(key) / found->at;
    return found;
  };
  if (path[0] != "*") {
    const auto field = value.is_object() ? value.find(path[0]) : value.end();
    return field == value.end() ? std::nullopt : find_below(*field, std::string(path[0]));
  }
  if (value.is_object()) {
    for (const auto& [key, below] : value.items()) {
      if (auto found = find_below(below, key)) return found;
    }
  }
  for (std::size_t i = 0; value.is_array() && i < value.size(); ++i) {
    if (auto found = find_below(value[i], i)) return found;
  }
  return std::nullopt;
}

[[noreturn]] void fail_dangling(const GltfDocument& document, const Dangling& found,
                                const char* kind, std::size_t count, const char* owner) {
  fail_at(document, found.at.to_string(), "gltf.invalid",
          fmt::format("{} {} does not exist; the {} has {}", kind, found.index, owner, count),
          "its exporter is at fault; export it again");
}

/// Channels have a sampler of their own animation.
void check_channels(const GltfDocument& document) {
  static constexpr std::string_view kSampler[] = {"*", "sampler"};
  const auto animations = document.json.find("animations");
  for (std::size_t a = 0; animations != document.json.end() && a < animations->size(); ++a) {
    const Json& animation = (*animations)[a];
    const std::size_t count = animation.at("samplers").size();
    std::optional<Dangling> found = find_dangling(animation.at("channels"), kSampler, count);
    if (!found) continue;
    found->at = Json::json_pointer() / "animations" / a / "channels" / found->at;
    fail_dangling(document, *found, "sampler", count, "animation");
  }
}

}  // namespace

void check_references(const GltfDocument& document) {
  const Json& json = document.json;
  for (const Reference& reference : kReferences) {
    const auto list = json.find(reference.list);
    const std::size_t count = list == json.end() ? 0 : list->size();
    const std::vector<std::string_view> keys = keys_of(reference.fields);
    const std::optional<Dangling> found = find_dangling(json, keys, count);
    if (found) fail_dangling(document, *found, reference.kind, count, "file");
  }
  check_channels(document);
}

}  // namespace morphbake
