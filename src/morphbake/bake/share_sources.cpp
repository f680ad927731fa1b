#include "morphbake/bake/share_sources.h"

#include <fmt/core.h>

#include <utility>

#include "morphbake/bake/mismatch_picture.h"
#include "morphbake/connectivity/mismatch.h"
#include "morphbake/files/files.h"

namespace morphbake {
namespace {

void write_picture(const std::filesystem::path& file, const Image& picture) {
  PendingOutputs outputs;
  outputs.stage(file, encode_png(picture));
  outputs.commit();
}

}  // namespace

void check_connected_alike(const Recipe& recipe, const std::vector<SourceMesh>& sources,
                           const std::filesystem::path& picture, const BakeOptions& options,
                           const Observer& observer) {
  if (recipe.connectivity.mode == ConnectivityMode::Remesh) return;
  const SourceMesh& first = sources.front();
  for (const SourceMesh& other : sources) {
    stop_if_cancelled(observer);
    const TopologyMismatch mismatch = find_mismatch(first, other);
    if (!mismatch.any()) continue;
    std::vector<Problem> problems = {mismatch_problem(first, other, mismatch)};
    try {
      write_picture(picture, mismatch_picture(first, other, mismatch, options, observer));
      std::string& hint = problems[0].hint;
      hint = fmt::format("{} shows where; {}", picture.string(), hint);
    } catch (const BakeError& error) {  // no picture is the smaller trouble
      problems.insert(problems.end(), error.problems().begin(), error.problems().end());
    }
    throw BakeError(std::move(problems));
  }
}

MorphableMesh share_sources(const std::vector<SourceMesh>& sources, ConnectivityReport& report,
                            const Observer& observer) {
  MorphableMesh mesh = share_connectivity(sources);
  if (report.mode != ConnectivityMode::Shared) return mesh;
  for (const Problem& warning :
       surface_warnings(sources.front(), mesh.names, mesh.connectivity.triangles, mesh.geometries,
                        mesh.repairs)) {
    morphbake::report(observer, warning);
  }
  for (const std::string& name : mesh.names) report.repairs.push_back({name, mesh.repairs});
  return mesh;
}

}  // namespace morphbake
