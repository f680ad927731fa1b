#include "morphbake/correspondence/source_topology.h"

#include <fmt/core.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>

#include "morphbake/mesh/adjacency.h"

namespace morphbake {
namespace {

constexpr std::size_t kPlaces = 3;  // how many holes a message places

/// A vertex of each border, and how many edges it has.
std::vector<std::pair<int, int>> borders_of(std::map<int, int> next) {
  std::vector<std::pair<int, int>> borders;
  while (!next.empty()) {
    auto& [first, edges] = borders.emplace_back(next.begin()->first, 0);
    for (int v = first; next.count(v) > 0; ++edges) v = next.extract(v).mapped();
  }
  return borders;
}

std::string shown(const SourceSurface& source, const std::pair<int, int>& border) {
  const auto at = source.mesh.positions.row(border.first);
  return fmt::format("one of {} edges at ({:.4g}, {:.4g}, {:.4g})", border.second, at(0), at(1),
                     at(2));
}

Problem problem_of(const SourceSurface& source, const char* code, std::string message,
                   std::string hint) {
  return {Severity::Error, code, {source.file, "", 0, 0}, std::move(message), std::move(hint)};
}

Problem holes_of(const SourceSurface& source, const std::vector<std::pair<int, int>>& borders) {
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

std::map<int, int> boundary_steps(const Triangles& triangles) {
  std::vector<std::array<int, 3>> edges;  // smaller end, larger end, whether it runs upwards
  for (Eigen::Index f = 0; f < triangles.rows(); ++f) {
    for (int k = 0; k < 3; ++k) {
      const int a = triangles(f, k), b = triangles(f, (k + 1) % 3);
      edges.push_back({std::min(a, b), std::max(a, b), a < b});
    }
  }
  std::sort(edges.begin(), edges.end());
  std::map<int, int> next;
  for (std::size_t e = 0; e < edges.size(); ++e) {
    const auto same = [&](std::size_t other) {
      return other < edges.size() && edges[other][0] == edges[e][0] &&
             edges[other][1] == edges[e][1];
    };
    if (same(e + 1) || (e > 0 && same(e - 1))) continue;
    const auto [low, high, upwards] = edges[e];
    next[upwards ? high : low] = upwards ? low : high;
  }
  return next;
}

std::vector<Problem> topology_problems(const SourceSurface& source) {
  std::vector<Problem> problems;
  const auto vertices = static_cast<int>(source.mesh.positions.rows());
  const auto triangles = static_cast<int>(source.mesh.triangles.rows());
  const std::map<int, int> boundary = boundary_steps(source.mesh.triangles);
  const std::vector<std::pair<int, int>> borders = borders_of(boundary);
  const int pieces = connected_components(one_rings({vertices, source.mesh.triangles})).count;
  if (pieces > 1) {
    problems.push_back(problem_of(
        source, "correspondence.pieces",
        fmt::format("\"{}\" consists of {} pieces; a remesh needs one", source.name, pieces),
        "join or delete the pieces; in Blender: Mesh > Separate > By Loose Parts shows them"));
  }
  if (borders.size() > 1) problems.push_back(holes_of(source, borders));
  const int edges = (3 * triangles + static_cast<int>(boundary.size())) / 2;
  const int loops = static_cast<int>(borders.size());
  const int handles = (2 * pieces - loops - (vertices - edges + triangles)) / 2;
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
  std::vector<std::pair<int, int>> border_of_first;
  for (const SourceSurface& source : sources) {
    if (source.mesh.triangles.rows() == 0) continue;
    const std::vector<Problem> own = topology_problems(source);
    problems.insert(problems.end(), own.begin(), own.end());
    if (!own.empty()) continue;
    const auto border = borders_of(boundary_steps(source.mesh.triangles));
    if (first == nullptr) {
      first = &source;
      border_of_first = border;
    }
    if (border.empty() == border_of_first.empty()) continue;
    const auto kind = [](const SourceSurface& of, const std::vector<std::pair<int, int>>& its) {
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
