// A library of small recipes: what the batch itself takes beside the bakes.

#include <fmt/core.h>

#include <algorithm>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <set>
#include <stdexcept>

#include "bench/timing.h"
#include "morphbake/batch/line_reader.h"
#include "morphbake/batch/run_batch.h"
#include "morphbake/files/temporary_folder.h"
#include "shapes/shapes.h"

namespace morphbake::bench {
namespace {

namespace fs = std::filesystem;

constexpr int kConnectivities = 10;
constexpr int kProcesses = 2;

void write_gltf(const fs::path& folder, const std::string& name, const Mesh& mesh) {
  const Eigen::Matrix<float, Eigen::Dynamic, 3, Eigen::RowMajor> positions =
      mesh.positions.cast<float>();
  std::ofstream binary(folder / (name + ".bin"), std::ios::binary);
  const auto bytes = [&](const auto& rows) {
    const auto count = static_cast<std::size_t>(rows.size()) * sizeof(*rows.data());
    binary.write(reinterpret_cast<const char*>(rows.data()), static_cast<std::streamsize>(count));
    return count;
  };
  const std::size_t vectors = bytes(positions), indices = bytes(mesh.triangles);
  const Eigen::RowVector3f low = positions.colwise().minCoeff(),
                           high = positions.colwise().maxCoeff();
  std::ofstream(folder / (name + ".gltf")) << fmt::format(
      R"({{"asset":{{"version":"2.0"}},"scene":0,"scenes":[{{"nodes":[0]}}],"nodes":[{{"mesh":0}}],)"
      R"("meshes":[{{"primitives":[{{"attributes":{{"POSITION":0}},"indices":1}}]}}],)"
      R"("buffers":[{{"byteLength":{},"uri":"{}.bin"}}],"bufferViews":[{{"buffer":0,"byteLength":{}}},)"
      R"({{"buffer":0,"byteOffset":{},"byteLength":{}}}],"accessors":[{{"bufferView":0,)"
      R"("componentType":5126,"count":{},"type":"VEC3","min":[{},{},{}],"max":[{},{},{}]}},)"
      R"({{"bufferView":1,"componentType":5125,"count":{},"type":"SCALAR"}}]}})",
      vectors + indices, name, vectors, vectors, indices, positions.rows(), low(0), low(1), low(2),
      high(0), high(1), high(2), mesh.triangles.size());
}

/// Writes recipes that differ in their regions, with a new connectivity in common each tenth.
///
/// @return  the list of the first `count`
fs::path write_library(const fs::path& folder, int count) {
  for (int c = 0; c < kConnectivities; ++c) {
    Mesh mesh = test::sphere(64, 96);
    write_gltf(folder, fmt::format("ball{}", c), mesh);
    mesh.positions = test::bent(mesh.positions, 0.2, static_cast<unsigned>(c + 1));
    write_gltf(folder, fmt::format("bent{}", c), mesh);
  }
  const fs::path list = folder / fmt::format("{}.jsonl", count);
  std::ofstream lines(list);
  for (int i = 0; i < count; ++i) {
    const int c = i % kConnectivities;
    std::ofstream(folder / fmt::format("{}.json", i)) << fmt::format(
        R"({{"version":1,"name":"m{0}","sources":{{"ball":"ball{1}.gltf","bent":"bent{1}.gltf"}},)"
        R"("connectivity":{{"mode":"resample","target_edge_length":0.03,"max_error":0.02}},)"
        R"("regions":{{"top":{{"ball":{{"on":"ball","at":{{"position":[0,0,1]}},"inner":0.1,"outer":{2}}}}}}},)"
        R"("timeline":{{"tracks":[{{"name":"top","region":"top","to":"bent","begin":0,"end":1}}]}}}})",
        i, c, 0.3 + 1e-4 * i);
    lines << fmt::format("\"{}.json\"\n", i);
  }
  return list;
}

/// What the report says of a library.
struct Library {
  double seconds = 0;  ///< of all bakes
  int made = 0;        ///< connectivities that were not taken from the cache
  std::set<std::string> connectivities;
};

Library read_library(const fs::path& report) {
  Library library;
  for (LineReader reader(report); reader.next();) {
    const auto record = record_from_line(reader.line());
    if (!record || !record->is_done) throw std::runtime_error("bench: a recipe failed");
    library.seconds += record->seconds;
    const auto& cached = record->summary->cached;
    if (std::ranges::find(cached, "connectivity") == cached.end()) {
      const auto& stages = record->summary->stages;
      library.made += std::ranges::any_of(
          stages, [](const StageReport& stage) { return stage.name == "connectivity"; });
    }
    library.connectivities.insert(record->connectivity);
  }
  return library;
}

}  // namespace

void bench_batch(int count, Figures& figures) {
  const TemporaryFolder temporary("morphbake-bench-batch");
  const fs::path& folder = temporary.path();
  const std::string group = fmt::format("batch, {} recipes over {} connectivities, {} processes",
                                        count, kConnectivities, kProcesses);
  const auto run = [&](int recipes) {
    BatchOptions options;
    options.folder = folder / fmt::format("out-{}", recipes);
    options.cache = StageCache({folder / fmt::format("cache-{}", recipes)});
    options.processes = kProcesses;
    return run_batch(read_manifest(folder / fmt::format("{}.jsonl", recipes), {}), options, {});
  };
  write_library(folder, count / 10);
  write_library(folder, count);
  forget_peak_memory();
  run(count / 10);
  const double few = peak_memory();
  forget_peak_memory();
  const std::clock_t begin = std::clock();
  BatchResult result;
  const double wall = seconds_of([&] { result = run(count); });
  const double own = static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC;
  const double many = peak_memory();
  const Library library = read_library(result.report);
  const double bakes = library.seconds / kProcesses;
  const double again = seconds_of([&] { result = run(count); });
  if (result.progress.unchanged != static_cast<std::size_t>(count)) {
    throw std::runtime_error("bench: the second run bakes");
  }
  figures.push_back({group, "all", wall, "s", ""});
  figures.push_back({group, "a bake", 1e3 * library.seconds / count, "ms", "mean, in its process"});
  figures.push_back({group, "overhead", 100 * (wall / bakes - 1), "%",
                     "beyond the sum of the bakes' own times over the processes; bound: 5 %"});
  figures.push_back({group, "the batch's own time", 1e3 * own / count, "ms a recipe", "of a core"});
  figures.push_back({group, "connectivities made", static_cast<double>(library.made), "",
                     fmt::format("of {}", library.connectivities.size())});
  figures.push_back({group, "a second run", again, "s", "nothing has changed; bound: 2 s"});
  figures.push_back({group, "a third run", seconds_of([&] { run(count); }), "s",
                     "times tell, nothing is hashed"});
  figures.push_back({group, fmt::format("memory at {} recipes", count / 10), few / 1e6, "MB", ""});
  figures.push_back({group, fmt::format("memory at {} recipes", count), many / 1e6, "MB", ""});
}

}  // namespace morphbake::bench
