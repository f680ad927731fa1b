#include "morphbake/sources/corner_surface.h"

#include <fmt/core.h>
#include <fmt/format.h>

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <set>
#include <utility>

#include "morphbake/diagnostics/problem.h"
#include "morphbake/mesh/adjacency.h"

namespace morphbake {
namespace {

constexpr int kPlaces = 3;  // how many places a message names

std::string place_of(const Positions& positions, int vertex) {
  return fmt::format("({:.4g}, {:.4g}, {:.4g})", positions(vertex, 0), positions(vertex, 1),
                     positions(vertex, 2));
}

}  // namespace

void fail_source(const SourceMesh& source, const std::string& code, const std::string& message,
                 const std::string& hint) {
  const std::string pointer = fmt::format("/meshes/{}", source.geometry.mesh);
  throw BakeError(
      Problem{Severity::Error, code, {file_of(source.file), pointer, 0, 0}, message, hint});
}

std::vector<int> welded_corners(const SourceMesh& source) {
  std::vector<int> corners(static_cast<std::size_t>(source.triangles.size()));
  for (std::size_t c = 0; c < corners.size(); ++c) {
    corners[c] = source.welded[static_cast<std::size_t>(source.triangles.data()[c])];
  }
  return corners;
}

std::vector<int> proper_triangles(const std::vector<int>& corner_classes) {
  std::vector<int> proper;
  for (std::size_t f = 0; f < corner_classes.size() / 3; ++f) {
    const int* t = corner_classes.data() + 3 * f;
    const bool is_degenerate = t[0] == t[1] || t[1] == t[2] || t[2] == t[0];
    if (!is_degenerate) proper.push_back(static_cast<int>(f));
  }
  return proper;
}

std::vector<int> without_duplicates(const std::vector<int>& corner_classes,
                                    const std::vector<int>& triangles) {
  std::set<std::array<int, 3>> seen;
  std::vector<int> kept;
  for (const int f : triangles) {
    const int* t = corner_classes.data() + 3 * static_cast<std::size_t>(f);
    std::array<int, 3> corners{t[0], t[1], t[2]};
    std::sort(corners.begin(), corners.end());
    if (seen.insert(corners).second) kept.push_back(f);
  }
  return kept;
}

CornerSurface surface_of_corners(const std::vector<int>& corner_classes,
                                 const std::vector<int>& triangles) {
  CornerSurface surface;
  std::vector<int> number(corner_classes.size(), -1);  // corner class -> vertex
  surface.connectivity.triangles.resize(static_cast<Eigen::Index>(triangles.size()), 3);
  surface.file_corner.reserve(3 * triangles.size());
  Eigen::Index row = 0;
  for (const int f : triangles) {
    for (int k = 0; k < 3; ++k) {
      const int corner = 3 * f + k;
      int& vertex =
          number[static_cast<std::size_t>(corner_classes[static_cast<std::size_t>(corner)])];
      if (vertex < 0) vertex = surface.connectivity.vertex_count++;
      surface.connectivity.triangles(row, k) = vertex;
      surface.file_corner.push_back(corner);
    }
    ++row;
  }
  for (const int corner_class : corner_classes) {
    surface.vertex_of_corner.push_back(number[static_cast<std::size_t>(corner_class)]);
  }
  return surface;
}

void wind_as_seen(const SourceMesh& source, CornerSurface& surface) {
  if (source.geometry.to_scene.topLeftCorner<3, 3>().determinant() >= 0) return;
  surface.connectivity.triangles.col(1).swap(surface.connectivity.triangles.col(2));
  for (std::size_t c = 0; c < surface.file_corner.size(); c += 3) {
    std::swap(surface.file_corner[c + 1], surface.file_corner[c + 2]);
  }
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

void check_manifold(const SourceMesh& source, const Connectivity& connectivity,
                    const Positions& positions) {
  if (connectivity.vertex_count == 0) {
    fail_source(source, "connectivity.empty",
                "the mesh has no triangle with three different corners",
                "export a mesh that has a surface");
  }
  const ManifoldDefects defects = find_manifold_defects(connectivity, kPlaces);
  if (defects.none()) return;
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
          ? "in Blender: Mesh > Normals > Recalculate Outside; a strip that is twisted once "
            "has no outside"
          : "in Blender: Mesh > Clean Up > Merge by Distance, then Select > All by Trait > "
            "Non Manifold shows the places");
}

}  // namespace morphbake
