#include "morphbake/export/render_normals.h"

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <map>

#include "morphbake/mesh/normals.h"

namespace morphbake {
namespace {

/// Lists the file's triangles that K has, and the groups of their corners.
void add_drawn_triangles(const SourceMesh& first, const MorphableMesh& mesh,
                         SmoothingGroups& groups) {
  for (int f = 0; f < static_cast<int>(mesh.triangle_of_file.size()); ++f) {
    const int of_k = mesh.triangle_of_file[static_cast<std::size_t>(f)];
    if (of_k < 0) continue;
    groups.triangles.push_back(of_k);
    for (const int vertex : mesh.connectivity.triangles.row(of_k)) {
      for (const int render : first.triangles.row(f)) {
        if (mesh.vertex_of_render[static_cast<std::size_t>(render)] != vertex) continue;
        groups.of_corner.push_back(groups.of_render[static_cast<std::size_t>(render)]);
      }
    }
  }
}

/// Normals of the groups on K's surface.
Normals surface_normals(const SmoothingGroups& groups, const MorphableMesh& mesh,
                        const Positions& positions) {
  const Triangles drawn = mesh.connectivity.triangles(groups.triangles, Eigen::all);
  return corner_group_normals(positions, drawn, groups.of_corner, groups.count);
}

}  // namespace

SmoothingGroups find_smoothing_groups(const SourceMesh& first, const MorphableMesh& mesh) {
  SmoothingGroups groups;
  const Float3s normals = file_normals(first);
  if (normals.rows() == 0) return groups;
  using NormalBits = std::array<float, 3>;
  std::vector<std::map<NormalBits, int>> at_vertex(
      static_cast<std::size_t>(mesh.connectivity.vertex_count));
  std::vector<int> render_of_group;
  groups.of_render.assign(mesh.vertex_of_render.size(), -1);
  for (std::size_t r = 0; r < mesh.vertex_of_render.size(); ++r) {
    const int vertex = mesh.vertex_of_render[r];
    if (vertex < 0) continue;
    const auto row = normals.row(static_cast<Eigen::Index>(r));
    const auto [entry, is_new] = at_vertex[static_cast<std::size_t>(vertex)].try_emplace(
        NormalBits{row(0), row(1), row(2)}, groups.count);
    groups.of_render[r] = entry->second;
    if (!is_new) continue;
    ++groups.count;
    render_of_group.push_back(static_cast<int>(r));
  }
  add_drawn_triangles(first, mesh, groups);
  // Normals go to the scene by the inverse transpose (glTF 2.0, 3.7.2.1).
  const Eigen::Matrix3d inverse = first.geometry.to_scene.topLeftCorner<3, 3>().inverse();
  const Float3s chosen = normals(render_of_group, Eigen::all);
  groups.surface_normals = surface_normals(groups, mesh, mesh.geometries[0]);
  groups.source_normals = chosen.cast<double>() * inverse;
  for (int g = 0; g < groups.count; ++g) {
    const double length = groups.source_normals.row(g).norm();
    if (length > 0) {
      groups.source_normals.row(g) /= length;
    } else {  // a NORMAL without length says nothing; the surface does
      groups.source_normals.row(g) = groups.surface_normals.row(g);
    }
  }
  return groups;
}

Normals deformed_normals(const SmoothingGroups& groups, const MorphableMesh& mesh,
                         const Positions& positions) {
  const Normals surface = surface_normals(groups, mesh, positions);
  Normals normals = groups.source_normals;
  for (int g = 0; g < groups.count; ++g) {
    const Eigen::Vector3d from = groups.surface_normals.row(g);
    const Eigen::Vector3d to = surface.row(g);
    // Where all triangles have collapsed, on either side, there is no turn to follow.
    if (from.isZero(0) || to.isZero(0) || from == to) continue;
    normals.row(g) = carry_normal(from, to, groups.source_normals.row(g)).normalized();
  }
  return normals;
}

}  // namespace morphbake
