#include "morphbake/correspondence/source_topology.h"

#include <fmt/core.h>
#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "morphbake/mesh/adjacency.h"
#include "morphbake/mesh/boundary.h"

namespace morphbake {
namespace {

constexpr std::size_t kPlaces = 3;  // how many holes a message places

std::string shown(const SourceSurface& source, const std::vector<int>& border) {
  const auto at = source.mesh.positions.row(border.back());
  return fmt::format("one of {} edges at ({:.4g}, {:.4g}, {:.4g})", border.size(), at(0), at(1),
                     at(2));
}

Problem problem_of(const SourceSurface& source, const char* code, std::string message,
                   std::string hint) {
  return {Severity::Error, code, {source.file, "", 0, 0}, std::move(message), std::move(hint)};
}

Problem holes_of(const SourceSurface& source, const std::vector<std::vector<int>>& borders) {
  std::vector<std::string> places;
  for (std::size_t i = 0; i < std::min(kPlaces, borders.size()); ++i) {
    places.push_back(shown(source, borders[i]));
  }
  return problem_of(
      source, "correspondence.holes",
      fmt::format("\"{}\" has {} holes, {}{}; a remesh takes closed surfaces, or disks with one "
                  "border",
                  source.name, borders.size(), fmt::join(places, ", "),
                  borders.size() > kPlaces ? ", ..." : ""),
      "fill the holes that are not meant; in Blender: Mesh > Clean Up > Fill Holes");
}

}  // namespace

std::vector<Problem> topology_problems(const SourceSurface& source) {
  std::vector<Problem> problems;
  const auto vertices = static_cast<int>(source.mesh.positions.rows());
  const auto triangles = static_cast<int>(source.mesh.triangles.rows());
  const std::vector<std::vector<int>> borders = boundary_loops(source.mesh.triangles);
  const int pieces = connected_components(one_rings({vertices, source.mesh.triangles})).count;
  if (pieces > 1) {
    problems.push_back(problem_of(
        source, "correspondence.pieces",
        fmt::format("\"{}\" consists of {} pieces; a remesh needs one", source.name, pieces),
        "join or delete the pieces; in Blender: Mesh > Separate > By Loose Parts shows them"));
  }
  if (borders.size() > 1) problems.push_back(holes_of(source, borders));
  int sides = 3 * triangles;
  for (const std::vector<int>& border : borders) sides += static_cast<int>(border.size());
  const int loops = static_cast<int>(borders.size());
  const int handles = (2 * pieces - loops - (vertices - sides / 2 + triangles)) / 2;
  if (handles > 0) {
    problems.push_back(
        problem_of(source, "correspondence.handles",
                   fmt::format("\"{}\" has {} handle{}, as a cup has; a remesh takes none",
                               source.name, handles, handles == 1 ? "" : "s"),
                   "close the tunnel, or use sources that share their connectivity"));
  }
  if (vertices < 4) {
    problems.push_back(problem_of(
        source, "correspondence.too-few-vertices",
        fmt::format("\"{}\" has {} vertices; a remesh needs 4 or more", source.name, vertices),
        "use a mesh of some detail"));
  }
  return problems;
}

std::vector<Problem> topology_problems(const std::vector<SourceSurface>& sources) {
  std::vector<Problem> problems;
  const SourceSurface* first = nullptr;
  std::vector<std::vector<int>> border_of_first;
  for (const SourceSurface& source : sources) {
    if (source.mesh.triangles.rows() == 0) continue;
    const std::vector<Problem> own = topology_problems(source);
    problems.insert(problems.end(), own.begin(), own.end());
    if (!own.empty()) continue;
    const auto border = boundary_loops(source.mesh.triangles);
    if (first == nullptr) {
      first = &source;
      border_of_first = border;
    }
    if (border.empty() == border_of_first.empty()) continue;
    const auto kind = [](const SourceSurface& of, const std::vector<std::vector<int>>& its) {
      return its.empty() ? std::string("closed")
                         : fmt::format("open (it has a border, {})", shown(of, its.front()));
    };
    problems.push_back(problem_of(
        source, "correspondence.different-topology",
        fmt::format("\"{}\" is {} but \"{}\" is {}", source.name, kind(source, border), first->name,
                    kind(*first, border_of_first)),
        "all sources of a remesh are closed, or all are disks: cut or fill one of them"));
  }
  return problems;
}

}  // namespace morphbake
