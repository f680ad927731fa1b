// SPDX-License-Identifier: GPL-3.0-or-later
#include "glb.h"

#include <bit>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <utility>
#include <vector>

namespace shapes {
namespace {

static_assert(std::endian::native == std::endian::little, "glTF is little-endian");

using Json = nlohmann::ordered_json;

/// What a view's bytes are for; glTF wants no word on images.
enum class Target { Image = 0, Vertices = 34962, Indices = 34963 };

/// The binary chunk as it grows, with the views and accessors that describe it.
class Buffer {
 public:
  template <typename Numbers>
  int append_view(const Numbers& numbers, Target target) {
    const std::size_t size = numbers.size() * sizeof(typename Numbers::value_type);
    Json view{{"buffer", 0}, {"byteOffset", bytes_.size()}, {"byteLength", size}};
    if (target != Target::Image) view["target"] = static_cast<int>(target);
    views_.push_back(std::move(view));
    bytes_.append(reinterpret_cast<const char*>(numbers.data()), size);
    bytes_.resize((bytes_.size() + 3) / 4 * 4, '\0');
    return static_cast<int>(views_.size()) - 1;
  }

  template <typename Numbers>
  int append(const Numbers& numbers, Target target, Json accessor) {
    accessor["bufferView"] = append_view(numbers, target);
    accessors_.push_back(std::move(accessor));
    return static_cast<int>(accessors_.size()) - 1;
  }

  const std::string& bytes() const { return bytes_; }

  const Json& views() const { return views_; }

  const Json& accessors() const { return accessors_; }

 private:
  std::string bytes_;
  Json views_ = Json::array();
  Json accessors_ = Json::array();
};

template <typename Rows>
int append_rows(Buffer& buffer, const Rows& rows, bool with_range) {
  const Eigen::Matrix<float, Eigen::Dynamic, Rows::ColsAtCompileTime, Eigen::RowMajor> values =
      rows.template cast<float>();
  Json accessor{{"componentType", 5126},
                {"count", rows.rows()},
                {"type", rows.cols() == 3 ? "VEC3" : "VEC2"}};
  if (with_range) {
    for (const float low : values.colwise().minCoeff().eval()) accessor["min"].push_back(low);
    for (const float high : values.colwise().maxCoeff().eval()) accessor["max"].push_back(high);
  }
  return buffer.append(std::vector<float>(values.data(), values.data() + values.size()),
                       Target::Vertices, std::move(accessor));
}

int append_indices(Buffer& buffer, const Rows3i& triangles) {
  std::vector<std::uint16_t> indices;
  for (const int v : triangles.reshaped<Eigen::RowMajor>())
    indices.push_back(static_cast<std::uint16_t>(v));
  return buffer.append(indices, Target::Indices,
                       {{"componentType", 5123}, {"count", triangles.size()}, {"type", "SCALAR"}});
}

Json material_json(const Material& material) {
  Json surface{{"baseColorFactor", {1.0, 1.0, 1.0, 1.0}}};
  if (material.is_textured) surface["baseColorTexture"] = {{"index", 0}};
  surface["metallicFactor"] = 0.0;
  surface["roughnessFactor"] = material.roughness;
  return {{"name", material.name}, {"pbrMetallicRoughness", std::move(surface)}};
}

Json append_primitive(Buffer& buffer, const Primitive& primitive, std::size_t material) {
  const int indices = append_indices(buffer, primitive.triangles);
  Json attributes{{"POSITION", append_rows(buffer, primitive.positions, true)},
                  {"NORMAL", append_rows(buffer, primitive.normals, false)}};
  if (primitive.colors.rows() > 0)
    attributes["COLOR_0"] = append_rows(buffer, primitive.colors, false);
  if (primitive.uv.rows() > 0) attributes["TEXCOORD_0"] = append_rows(buffer, primitive.uv, false);
  return {{"attributes", std::move(attributes)}, {"indices", indices}, {"material", material}};
}

void add_texture(Buffer& buffer, const std::string& name, const std::string& png, Json& gltf) {
  constexpr int linear = 9729;
  constexpr int linear_mipmap_linear = 9987;
  gltf["textures"] = Json::array({{{"sampler", 0}, {"source", 0}}});
  gltf["samplers"] = Json::array({{{"magFilter", linear}, {"minFilter", linear_mipmap_linear}}});
  gltf["images"] = Json::array({{{"name", name},
                                 {"mimeType", "image/png"},
                                 {"bufferView", buffer.append_view(png, Target::Image)}}});
}

Json document(const std::string& name, const Model& model, Buffer& buffer) {
  Json primitives = Json::array();
  Json materials = Json::array();
  for (const Primitive& primitive : model.primitives) {
    primitives.push_back(append_primitive(buffer, primitive, materials.size()));
    materials.push_back(material_json(primitive.material));
  }
  Json gltf;
  gltf["asset"] = {{"version", "2.0"},
                   {"generator", "morphbake examples/shapes"},
                   {"copyright", "morphbake authors, GPL-3.0-or-later"}};
  gltf["scene"] = 0;
  gltf["scenes"] = Json::array({{{"nodes", {0}}}});
  gltf["nodes"] = Json::array({{{"name", name}, {"mesh", 0}}});
  gltf["meshes"] = Json::array({{{"name", name}, {"primitives", std::move(primitives)}}});
  gltf["materials"] = std::move(materials);
  if (!model.texture.empty()) add_texture(buffer, name, model.texture, gltf);
  gltf["accessors"] = buffer.accessors();
  gltf["bufferViews"] = buffer.views();
  gltf["buffers"] = Json::array({{{"byteLength", buffer.bytes().size()}}});
  return gltf;
}

void write_word(std::ostream& out, std::size_t word) {
  const auto value = static_cast<std::uint32_t>(word);
  char bytes[4];
  std::memcpy(bytes, &value, 4);
  out.write(bytes, 4);
}

void write_chunk(std::ostream& out, std::size_t type, const std::string& bytes) {
  write_word(out, bytes.size());
  write_word(out, type);
  out.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
}

}  // namespace

Model painted_model(const Mesh& mesh) {
  Model model;
  Primitive& primitive = model.primitives.emplace_back();
  primitive.material.name = "painted";
  primitive.positions = mesh.positions;
  primitive.normals = vertex_normals(mesh);
  primitive.colors = mesh.colors;
  primitive.triangles = mesh.triangles;
  return model;
}

void write_glb(const std::filesystem::path& file, const std::string& name, const Model& model) {
  for (const Primitive& primitive : model.primitives)
    if (primitive.positions.rows() > 65535) throw std::runtime_error(name + ": too many vertices");
  Buffer buffer;
  std::string json = document(name, model, buffer).dump();
  json.resize((json.size() + 3) / 4 * 4, ' ');
  std::ofstream out(file, std::ios::binary);
  write_word(out, 0x46546C67);  // "glTF"
  write_word(out, 2);
  write_word(out, 12 + 8 + json.size() + 8 + buffer.bytes().size());
  write_chunk(out, 0x4E4F534A, json);  // "JSON"
  write_chunk(out, 0x004E4942, buffer.bytes());
  if (!out.flush()) throw std::runtime_error("cannot write " + file.string());
}

}  // namespace shapes
