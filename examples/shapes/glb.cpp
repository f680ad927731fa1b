// SPDX-License-Identifier: GPL-3.0-or-later
#include "glb.h"

#include <bit>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <vector>

namespace shapes {
namespace {

static_assert(std::endian::native == std::endian::little, "glTF is little-endian");

using Json = nlohmann::ordered_json;

enum class Target { Vertices = 34962, Indices = 34963 };

/// The binary chunk as it grows, with the views and accessors that describe it.
class Buffer {
 public:
  template <typename Number>
  int append(const std::vector<Number>& numbers, Target target, Json accessor) {
    const std::size_t bytes = numbers.size() * sizeof(Number);
    views_.push_back({{"buffer", 0},
                      {"byteOffset", bytes_.size()},
                      {"byteLength", bytes},
                      {"target", static_cast<int>(target)}});
    const auto* begin = reinterpret_cast<const char*>(numbers.data());
    bytes_.append(begin, bytes);
    bytes_.resize((bytes_.size() + 3) / 4 * 4, '\0');
    accessor["bufferView"] = views_.size() - 1;
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

int append_rows(Buffer& buffer, const Rows3d& rows, bool with_range) {
  const Eigen::Matrix<float, Eigen::Dynamic, 3, Eigen::RowMajor> values = rows.cast<float>();
  Json accessor{{"componentType", 5126}, {"count", rows.rows()}, {"type", "VEC3"}};
  if (with_range) {
    const Eigen::RowVector3f low = values.colwise().minCoeff();
    const Eigen::RowVector3f high = values.colwise().maxCoeff();
    accessor["min"] = {low[0], low[1], low[2]};
    accessor["max"] = {high[0], high[1], high[2]};
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

Json material() {
  return {{"name", "painted"},
          {"pbrMetallicRoughness",
           {{"baseColorFactor", {1.0, 1.0, 1.0, 1.0}},
            {"metallicFactor", 0.0},
            {"roughnessFactor", 0.7}}}};
}

Json document(const std::string& name, const Mesh& mesh, Buffer& buffer) {
  const int indices = append_indices(buffer, mesh.triangles);
  Json attributes{{"POSITION", append_rows(buffer, mesh.positions, true)},
                  {"NORMAL", append_rows(buffer, vertex_normals(mesh), false)},
                  {"COLOR_0", append_rows(buffer, mesh.colors, false)}};
  Json primitive{{"attributes", std::move(attributes)}, {"indices", indices}, {"material", 0}};
  Json gltf;
  gltf["asset"] = {{"version", "2.0"},
                   {"generator", "morphbake examples/shapes"},
                   {"copyright", "morphbake authors, GPL-3.0-or-later"}};
  gltf["scene"] = 0;
  gltf["scenes"] = Json::array({{{"nodes", {0}}}});
  gltf["nodes"] = Json::array({{{"name", name}, {"mesh", 0}}});
  gltf["meshes"] = Json::array({{{"name", name}, {"primitives", Json::array({primitive})}}});
  gltf["materials"] = Json::array({material()});
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

void write_glb(const std::filesystem::path& file, const std::string& name, const Mesh& mesh) {
  if (mesh.positions.rows() > 65535) throw std::runtime_error(name + ": too many vertices");
  Buffer buffer;
  std::string json = document(name, mesh, buffer).dump();
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
