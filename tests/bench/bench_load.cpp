// Reading a large source, beside what tinygltf alone takes for the same file.

#include <fmt/core.h>
#define TINYGLTF_NO_STB_IMAGE
#define TINYGLTF_NO_STB_IMAGE_WRITE
#include <tiny_gltf.h>

#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "bench/timing.h"
#include "morphbake/sources/source_mesh.h"
#include "shapes/shapes.h"

namespace morphbake::bench {
namespace {

namespace fs = std::filesystem;

std::string raw(const auto& rows) {
  return {reinterpret_cast<const char*>(rows.data()),
          static_cast<std::size_t>(rows.size()) * sizeof(*rows.data())};
}

std::string chunk(const char* type, std::string bytes, char padding) {
  bytes.resize((bytes.size() + 3) / 4 * 4, padding);
  const auto size = static_cast<std::uint32_t>(bytes.size());
  return std::string(reinterpret_cast<const char*>(&size), 4) + std::string(type, 4) + bytes;
}

/// A .glb as exporters write it: positions, normals, texture coordinates, 32-bit indices.
std::string torus_glb(int vertices) {
  const int side = static_cast<int>(std::sqrt(vertices / 2.0));
  const Mesh mesh = test::torus(2 * side, side);
  const Float3s positions = mesh.positions.cast<float>();
  const Float3s normals = mesh.positions.rowwise().normalized().cast<float>();
  const Float2s coordinates = positions.leftCols(2);
  const std::string binary = raw(positions) + raw(normals) + raw(coordinates) + raw(mesh.triangles);
  const std::size_t vectors = raw(positions).size(), pairs = raw(coordinates).size();
  const std::string json = fmt::format(
      R"({{"asset":{{"version":"2.0"}},"scene":0,"scenes":[{{"nodes":[0]}}],"nodes":[{{"mesh":0}}],)"
      R"("meshes":[{{"primitives":[{{"attributes":{{"POSITION":0,"NORMAL":1,"TEXCOORD_0":2}},"indices":3}}]}}],)"
      R"("buffers":[{{"byteLength":{0}}}],"bufferViews":[{{"buffer":0,"byteLength":{1}}},)"
      R"({{"buffer":0,"byteOffset":{1},"byteLength":{1}}},{{"buffer":0,"byteOffset":{2},"byteLength":{3}}},)"
      R"({{"buffer":0,"byteOffset":{4},"byteLength":{5}}}],"accessors":[)"
      R"({{"bufferView":0,"componentType":5126,"count":{6},"type":"VEC3","min":[-2,-2,-2],"max":[2,2,2]}},)"
      R"({{"bufferView":1,"componentType":5126,"count":{6},"type":"VEC3"}},)"
      R"({{"bufferView":2,"componentType":5126,"count":{6},"type":"VEC2"}},)"
      R"({{"bufferView":3,"componentType":5125,"count":{7},"type":"SCALAR"}}]}})",
      binary.size(), vectors, 2 * vectors, pairs, 2 * vectors + pairs, raw(mesh.triangles).size(),
      positions.rows(), mesh.triangles.size());
  const std::string chunks = chunk("JSON", json, ' ') + chunk("BIN", binary, '\0');
  const std::uint32_t header[] = {0x46546C67, 2, static_cast<std::uint32_t>(12 + chunks.size())};
  return std::string(reinterpret_cast<const char*>(header), sizeof header) + chunks;
}

void read_by_tinygltf(const fs::path& file) {
  tinygltf::Model model;
  std::string errors, warnings;
  if (!tinygltf::TinyGLTF().LoadBinaryFromFile(&model, &errors, &warnings, file.string())) {
    std::abort();
  }
}

}  // namespace

void bench_load(int vertices, Figures& figures) {
  const std::string group = fmt::format("load, {} vertices, .glb", shown_count(vertices));
  const fs::path file = fs::temp_directory_path() / "morphbake-bench-load.glb";
  std::ofstream(file, std::ios::binary) << torus_glb(vertices);
  const Pair pair = time_pair(
      9, [&] { read_by_tinygltf(file); }, [&] { read_source("source", open_gltf(file)); });
  fs::remove(file);
  figures.push_back({group, "tinygltf alone", pair.first * 1e3, "ms", ""});
  figures.push_back({group, "source, welded", pair.second * 1e3, "ms", ""});
  figures.push_back({group, "source / tinygltf", pair.ratio, "x", "pairs"});
}

}  // namespace morphbake::bench
