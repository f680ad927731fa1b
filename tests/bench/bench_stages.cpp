// What else a bake does: export, previews.

#include <fmt/core.h>

#include <cmath>
#include <filesystem>

#include "bench/timing.h"
#include "morphbake/files/files.h"
#include "morphbake/gltf/write_morph.h"
#include "morphbake/preview/turntable.h"
#include "shapes/shapes.h"

namespace morphbake::bench {
namespace {

namespace fs = std::filesystem;

Mesh torus_of(int vertices) {
  const int side = static_cast<int>(std::sqrt(vertices / 2.0));
  return test::torus(2 * side, side);
}

/// A folder that is removed again.
struct ScratchFolder {
  fs::path path = fs::temp_directory_path() / "morphbake-bench";

  ScratchFolder() { fs::create_directories(path); }

  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;

  ~ScratchFolder() { fs::remove_all(path); }
};

void write_file(const fs::path& file, const std::string& bytes) {
  PendingOutputs outputs;
  outputs.stage(file, bytes);
  outputs.commit();
}

std::string raw(const auto& rows) {
  return {reinterpret_cast<const char*>(rows.data()),
          static_cast<std::size_t>(rows.size()) * sizeof(*rows.data())};
}

/// A .gltf with its .bin: positions, normals, triangles.
fs::path write_source(const fs::path& folder, const Mesh& mesh) {
  const Float3s positions = mesh.positions.cast<float>();
  const Float3s normals = mesh.positions.rowwise().normalized().cast<float>();
  const std::string binary = raw(positions) + raw(normals) + raw(mesh.triangles);
  const auto bytes = static_cast<std::size_t>(positions.size()) * sizeof(float);
  write_file(folder / "source.bin", binary);
  write_file(
      folder / "source.gltf",
      fmt::format(
          R"({{"asset":{{"version":"2.0"}},"scene":0,"scenes":[{{"nodes":[0]}}],"nodes":[{{"mesh":0}}],)"
          R"("meshes":[{{"primitives":[{{"attributes":{{"POSITION":0,"NORMAL":1}},"indices":2}}]}}],)"
          R"("buffers":[{{"uri":"source.bin","byteLength":{0}}}],"bufferViews":[)"
          R"({{"buffer":0,"byteLength":{1}}},{{"buffer":0,"byteOffset":{1},"byteLength":{1}}},)"
          R"({{"buffer":0,"byteOffset":{2},"byteLength":{3}}}],"accessors":[)"
          R"({{"bufferView":0,"componentType":5126,"count":{4},"type":"VEC3","min":[-2,-2,-2],"max":[2,2,2]}},)"
          R"({{"bufferView":1,"componentType":5126,"count":{4},"type":"VEC3"}},)"
          R"({{"bufferView":2,"componentType":5125,"count":{5},"type":"SCALAR"}}]}})",
          binary.size(), bytes, 2 * bytes, raw(mesh.triangles).size(), positions.rows(),
          mesh.triangles.size()));
  return folder / "source.gltf";
}

MeshMorph morph_of(const Mesh& mesh, int targets) {
  MeshMorph morph;
  const Float3s positions = mesh.positions.cast<float>();
  const Float3s normals = mesh.positions.rowwise().normalized().cast<float>();
  morph.primitives = {{positions, normals, {}, {}}};
  for (int k = 0; k < targets; ++k) {
    morph.primitives[0].target_positions.push_back(
        (test::bent(mesh.positions, 0.1, static_cast<unsigned>(k + 1)) - mesh.positions)
            .cast<float>());
    morph.primitives[0].target_normals.push_back(normals * 0.1F);
    morph.target_names.push_back(fmt::format("t{}", k));
  }
  morph.clips = {{"bench", {0, 1}, Eigen::MatrixXf::Identity(2, targets)}};
  return morph;
}

}  // namespace

void bench_export(int vertices, Figures& figures) {
  const std::string group = fmt::format("export, {} vertices, 8 targets", shown_count(vertices));
  const ScratchFolder folder;
  const Mesh mesh = torus_of(vertices);
  const GltfFile source = open_gltf(write_source(folder.path, mesh));
  const MeshMorph morph = morph_of(mesh, 8);
  const std::string bytes = write_morph_glb(source, morph, "bench");
  const auto megabytes = static_cast<double>(bytes.size()) / 1e6;
  const Pair pair = time_pair(
      5, [&] { write_file(folder.path / "copy.glb", bytes); },
      [&] { write_file(folder.path / "morph.glb", write_morph_glb(source, morph, "bench")); });
  figures.push_back({group, "plain copy", megabytes / pair.first, "MB/s", "synced to disk"});
  figures.push_back({group, "export", megabytes / pair.second, "MB/s", "synced to disk"});
  figures.push_back({group, "export / copy, time", pair.ratio, "x", "pairs"});
}

void bench_preview(int vertices, Figures& figures) {
  const Mesh mesh = torus_of(vertices);
  const MeshMorph morph = morph_of(mesh, 1);
  AnimatedMesh animated;
  AnimatedPrimitive primitive;
  primitive.triangles = mesh.triangles;
  primitive.positions = morph.primitives[0].positions;
  primitive.normals = morph.primitives[0].normals;
  primitive.target_positions = morph.primitives[0].target_positions;
  primitive.target_normals = morph.primitives[0].target_normals;
  animated.primitives = {primitive};
  animated.target_names = {"t"};
  animated.weights.times = {0, 1};
  animated.weights.values = Eigen::MatrixXf::Identity(2, 1);
  animated.weights.values << 0, 1;
  TurntableOptions look;
  look.frames = 8;
  look.samples = 4;
  const double seconds = median_seconds(3, [&] { render_turntable(animated, look, {}); });
  figures.push_back({fmt::format("preview, {} triangles, 512 x 512, 4 samples",
                                 shown_count(static_cast<int>(mesh.triangles.rows()))),
                     "picture", seconds / look.frames * 1e3, "ms", "all cores"});
}

}  // namespace morphbake::bench
