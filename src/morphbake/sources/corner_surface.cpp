#include "morphbake/sources/corner_surface.h"

#include <fmt/core.h>
#include <fmt/format.h>

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <utility>

#include "morphbake/diagnostics/counted.h"
#include "morphbake/diagnostics/problem.h"
#include "morphbake/json/nearest.h"
#include "morphbake/mesh/adjacency.h"
#include "morphbake/mesh/open_seams.h"
#include "morphbake/mesh/orientation.h"

namespace morphbake {
namespace {

constexpr int kPlaces = 3;  // how many places a message names
constexpr int kMostAround = 16384;

std::string place_of(const Positions& positions, int vertex) {
  return fmt::format("({:.4g}, {:.4g}, {:.4g})", positions(vertex, 0), positions(vertex, 1),
                     positions(vertex, 2));
}

/// The triangles that are neither degenerate nor repeat an earlier one, rising; notes what becomes
/// of the rest.
std::vector<int> keep_triangles(const std::vector<int>& corner_classes, CornerSurface& surface) {
  std::vector<std::array<int, 4>> proper;  // the three classes, rising, and the triangle
  for (std::size_t f = 0; f < corner_classes.size() / 3; ++f) {
    const int* t = corner_classes.data() + 3 * f;
    std::array<int, 3> corners{t[0], t[1], t[2]};
    std::sort(corners.begin(), corners.end());
    if (corners[0] == corners[1] || corners[1] == corners[2]) {
      ++surface.repairs.degenerate;
    } else {
      proper.push_back({corners[0], corners[1], corners[2], static_cast<int>(f)});
    }
  }
  std::sort(proper.begin(), proper.end());
  const auto repeats = [&](std::size_t i) {
    return i > 0 && std::equal(proper[i].begin(), proper[i].begin() + 3, proper[i - 1].begin());
  };
  std::vector<int> kept;
  for (std::size_t i = 0; i < proper.size(); ++i) {
    if (!repeats(i)) kept.push_back(proper[i][3]);
  }
  std::sort(kept.begin(), kept.end());
  std::vector<int>& of_file = surface.triangle_of_file;
  of_file.assign(corner_classes.size() / 3, -1);
  for (std::size_t row = 0; row < kept.size(); ++row) {
    of_file[static_cast<std::size_t>(kept[row])] = static_cast<int>(row);
  }
  for (std::size_t i = 1; i < proper.size(); ++i) {
    if (!repeats(i)) continue;
    ++surface.repairs.duplicate;
    of_file[static_cast<std::size_t>(proper[i][3])] =
        of_file[static_cast<std::size_t>(proper[i - 1][3])];
  }
  return kept;
}

/// Numbers the classes of the surface's corners by first appearance.
void number_vertices(const std::vector<int>& corner_classes, CornerSurface& surface) {
  const int class_count =
      corner_classes.empty() ? 0 : *std::max_element(corner_classes.begin(), corner_classes.end());
  std::vector<int> number(static_cast<std::size_t>(class_count) + 1, -1);
  Connectivity& connectivity = surface.connectivity;
  connectivity.triangles.resize(static_cast<Eigen::Index>(surface.file_corner.size() / 3), 3);
  for (std::size_t c = 0; c < surface.file_corner.size(); ++c) {
    const auto corner = static_cast<std::size_t>(surface.file_corner[c]);
    int& vertex = number[static_cast<std::size_t>(corner_classes[corner])];
    if (vertex < 0) vertex = connectivity.vertex_count++;
    connectivity.triangles.data()[c] = vertex;
  }
  surface.vertex_of_corner.reserve(corner_classes.size());
  for (const int corner_class : corner_classes) {
    surface.vertex_of_corner.push_back(number[static_cast<std::size_t>(corner_class)]);
  }
}

void turn(int triangle, CornerSurface& surface) {
  Triangles& triangles = surface.connectivity.triangles;
  std::swap(triangles(triangle, 1), triangles(triangle, 2));
  const auto corners = surface.file_corner.begin() + 3 * triangle;
  std::swap(corners[1], corners[2]);
}

Problem source_problem(const SourceMesh& source, Severity severity, const char* code,
                       std::string message, std::string hint) {
  const std::string pointer = fmt::format("/meshes/{}", source.geometry.mesh);
  return {
      severity, code, {file_of(source.file), pointer, 0, 0}, std::move(message), std::move(hint)};
}

std::string repairs_text(const SurfaceRepairs& repairs) {
  const auto [degenerate, duplicate, turned] = repairs;
  std::vector<std::string> parts;
  const auto add = [&](int count, const char* what, const char* is_done) {
    if (count == 0) return;
    parts.push_back(fmt::format("{} {} {}", counted(count, what, std::string(what) + "s"),
                                count == 1 ? "is" : "are", is_done));
  };
  add(degenerate, "degenerate triangle", "left out");
  add(duplicate, "duplicate triangle", "left out");
  add(turned, "triangle", "turned to face as its neighbours");
  return fmt::format("{}", fmt::join(parts, ", "));
}

}  // namespace

void fail_source(const SourceMesh& source, const std::string& code, const std::string& message,
                 const std::string& hint) {
  throw BakeError(source_problem(source, Severity::Error, code.c_str(), message, hint));
}

std::vector<int> welded_corners(const SourceMesh& source) {
  std::vector<int> corners(static_cast<std::size_t>(source.triangles.size()));
  for (std::size_t c = 0; c < corners.size(); ++c) {
    corners[c] = source.welded[static_cast<std::size_t>(source.triangles.data()[c])];
  }
  return corners;
}

CornerSurface surface_of_corners(const SourceMesh& source, const std::vector<int>& corner_classes) {
  CornerSurface surface;
  const std::vector<int> kept = keep_triangles(corner_classes, surface);
  surface.file_corner.reserve(3 * kept.size());
  for (const int f : kept) {
    for (int k = 0; k < 3; ++k) surface.file_corner.push_back(3 * f + k);
  }
  number_vertices(corner_classes, surface);
  if (source.geometry.to_scene.topLeftCorner<3, 3>().determinant() < 0) {
    for (std::size_t f = 0; f < kept.size(); ++f) turn(static_cast<int>(f), surface);
  }
  const Orientation orientation = find_orientation(surface.connectivity.triangles);
  for (std::size_t f = 0; f < kept.size(); ++f) {
    if (orientation.is_turned[f] == 0) continue;
    turn(static_cast<int>(f), surface);
    ++surface.repairs.turned;
  }
  return surface;
}

std::vector<int> vertices_of_render(const SourceMesh& source, const CornerSurface& surface) {
  std::vector<int> vertices(static_cast<std::size_t>(source.positions.rows()), -1);
  for (std::size_t c = 0; c < surface.vertex_of_corner.size(); ++c) {
    const auto render = static_cast<std::size_t>(source.triangles.data()[c]);
    const int vertex = surface.vertex_of_corner[c];
    if (vertex >= 0) vertices[render] = vertex;
  }
  return vertices;
}

std::vector<int> render_corners(const SourceMesh& source, const CornerSurface& surface) {
  std::vector<int> render;
  render.reserve(surface.file_corner.size());
  for (const int corner : surface.file_corner) render.push_back(source.triangles.data()[corner]);
  return render;
}

Positions vertex_positions(const SourceMesh& source, const CornerSurface& surface) {
  Positions positions(surface.connectivity.vertex_count, 3);
  for (std::size_t c = 0; c < surface.vertex_of_corner.size(); ++c) {
    const int vertex = surface.vertex_of_corner[c];
    if (vertex >= 0) positions.row(vertex) = source.positions.row(source.triangles.data()[c]);
  }
  return positions;
}

bool runs_as_in_file(const CornerSurface& surface, int triangle) {
  const auto corners = surface.file_corner.begin() + 3 * triangle;
  return (corners[0] + 1) % 3 == corners[1] % 3;
}

std::vector<Problem> surface_warnings(const SourceMesh& first,
                                      const std::vector<std::string>& names,
                                      const Triangles& triangles,
                                      const std::vector<Positions>& geometries,
                                      const SurfaceRepairs& repairs) {
  std::vector<std::string> quoted;
  for (const std::string& name : names) quoted.push_back(fmt::format("\"{}\"", name));
  const std::string sources = name_list(quoted);
  std::vector<Problem> warnings;
  if (repairs.any()) {
    warnings.push_back(source_problem(
        first, Severity::Warning, "connectivity.repaired",
        fmt::format("of {}: {}; files keep their triangles", sources, repairs_text(repairs)),
        "in Blender: Mesh > Clean Up > Degenerate Dissolve and Merge by Distance, then Mesh > "
        "Normals > Recalculate Outside mend the file itself"));
  }
  const std::vector<Eigen::Vector2i> seams = find_open_seams(triangles, geometries);
  if (!seams.empty()) {
    std::vector<std::string> places;
    for (std::size_t i = 0; i < std::min<std::size_t>(kPlaces, seams.size()); ++i) {
      places.push_back(place_of(geometries[0], seams[i](0)));
    }
    warnings.push_back(source_problem(
        first, Severity::Warning, "connectivity.open-seams",
        fmt::format("{} of {} lie beside others but are not joined to them: first at {}",
                    counted(static_cast<int>(seams.size()), "border edge", "border edges"), sources,
                    fmt::join(places, ", ")),
        "a morph can tear there; in Blender: Mesh > Clean Up > Merge by Distance joins them"));
  }
  return warnings;
}

void check_manifold(const SourceMesh& source, const Connectivity& connectivity,
                    const Positions& positions) {
  if (connectivity.triangles.rows() == 0) {
    fail_source(source, "connectivity.empty",
                "the mesh has no triangle with three different corners",
                "export a mesh that has a surface");
  }
  const ManifoldDefects defects = find_manifold_defects(connectivity, kPlaces);
  std::vector<std::string> places;
  for (const Eigen::Vector2i& edge : defects.crowded_edges) {
    places.push_back(fmt::format("edge {} - {} has more than two triangles",
                                 place_of(positions, edge(0)), place_of(positions, edge(1))));
  }
  for (const int f : defects.misoriented_triangles) {
    places.push_back(fmt::format("the triangle at {} is turned against its neighbour",
                                 place_of(positions, connectivity.triangles(f, 0))));
  }
  for (const int v : defects.pinched_vertices) {
    places.push_back(fmt::format("the surface is pinched at {}", place_of(positions, v)));
  }
  if (places.empty()) return;
  // A triangle that is turned is one at each of its edges.
  std::vector<std::string> once;
  for (std::string& place : places) {
    if (std::find(once.begin(), once.end(), place) == once.end()) once.push_back(std::move(place));
  }
  const bool only_turned = defects.crowded_edges.empty() && defects.pinched_vertices.empty();
  fail_source(
      source, "connectivity.not-manifold",
      fmt::format("the surface is no oriented manifold: {}", fmt::join(once, "; ")),
      only_turned
          ? "the surface has no outside there, as a strip that is twisted once; cut it at the twist"
          : "in Blender: Mesh > Clean Up > Merge by Distance, then Select > All by Trait > "
            "Non Manifold shows the places");
}

void check_hubs(const SourceMesh& source, const Connectivity& connectivity,
                const Positions& positions) {
  std::vector<int> around(static_cast<std::size_t>(connectivity.vertex_count), 0);
  for (const int v : connectivity.triangles.reshaped()) ++around[static_cast<std::size_t>(v)];
  const auto hub = std::ranges::max_element(around);
  if (hub == around.end() || *hub <= kMostAround) return;
  fail_source(
      source, "connectivity.hub",
      fmt::format("{} triangles meet at {}; new triangles can be laid over {} at most", *hub,
                  place_of(positions, static_cast<int>(hub - around.begin())), kMostAround),
      "give the fan rings of vertices, or remesh it in a modeller first");
}

}  // namespace morphbake
