#include <fmt/core.h>
#include <fmt/format.h>

#include <Eigen/LU>
#include <algorithm>
#include <map>
#include <utility>

#include "morphbake/connectivity/morphable_mesh.h"
#include "morphbake/diagnostics/problem.h"
#include "morphbake/gltf/gltf_file.h"
#include "morphbake/mesh/adjacency.h"

namespace morphbake {
namespace {

constexpr int kPlaces = 3;  // how many places a message names

constexpr const char* kRemeshHint =
    "give them new triangles that fit all: \"connectivity\": {\"mode\": \"remesh\"}; or export "
    "poses or sculpts of one mesh alike";

[[noreturn]] void fail(const SourceMesh& source, const std::string& code,
                       const std::string& message, const std::string& hint) {
  const std::string pointer = fmt::format("/meshes/{}", source.geometry.mesh);
  throw BakeError(
      Problem{Severity::Error, code, {file_of(source.file), pointer, 0, 0}, message, hint});
}

/// Welded vertex of each triangle corner, corner 3 f + k.
std::vector<int> welded_corners(const SourceMesh& source) {
  std::vector<int> corners(static_cast<std::size_t>(source.triangles.size()));
  for (std::size_t c = 0; c < corners.size(); ++c) {
    corners[c] = source.welded[static_cast<std::size_t>(source.triangles.data()[c])];
  }
  return corners;
}

/// Classes of corners that are one class in both `a` and `b`, numbered by first appearance.
std::vector<int> common_refinement(const std::vector<int>& a, const std::vector<int>& b) {
  std::vector<std::pair<std::pair<int, int>, int>> keyed(a.size());
  for (std::size_t c = 0; c < a.size(); ++c) keyed[c] = {{a[c], b[c]}, static_cast<int>(c)};
  std::sort(keyed.begin(), keyed.end());
  std::vector<int> first(a.size());
  for (std::size_t i = 0; i < keyed.size(); ++i) {
    const bool same = i > 0 && keyed[i].first == keyed[i - 1].first;
    const auto corner = static_cast<std::size_t>(keyed[i].second);
    first[corner] = same ? first[static_cast<std::size_t>(keyed[i - 1].second)] : keyed[i].second;
  }
  std::vector<int> classes(a.size());
  int count = 0;
  for (std::size_t c = 0; c < a.size(); ++c) {
    const auto twin = static_cast<std::size_t>(first[c]);
    classes[c] = twin == c ? count++ : classes[twin];
  }
  return classes;
}

bool same_vertex_order(const SourceMesh& a, const SourceMesh& b) {
  return a.positions.rows() == b.positions.rows() && a.triangles == b.triangles;
}

void check_triangle_counts(const SourceMesh& first, const SourceMesh& other) {
  if (first.triangles.rows() == other.triangles.rows()) return;
  fail(other, "connectivity.different-triangles",
       fmt::format("\"{}\" has {} triangles but \"{}\" has {}", other.name, other.triangles.rows(),
                   first.name, first.triangles.rows()),
       kRemeshHint);
}

/// The welded surfaces agree when a vertex of one is always the same vertex of the other.
void check_same_topology(const SourceMesh& first, const SourceMesh& other,
                         const std::vector<int>& corners, const std::vector<int>& other_corners) {
  std::map<int, int> there, back;
  std::vector<std::size_t> places;
  for (std::size_t c = 0; c < corners.size() && places.size() < kPlaces; ++c) {
    const bool agrees =
        there.try_emplace(corners[c], other_corners[c]).first->second == other_corners[c] &&
        back.try_emplace(other_corners[c], corners[c]).first->second == corners[c];
    if (!agrees && (places.empty() || places.back() != c / 3)) places.push_back(c / 3);
  }
  if (places.empty()) return;
  fail(other, "connectivity.different-topology",
       fmt::format("\"{}\" and \"{}\" are not connected alike: first at triangles {}", other.name,
                   first.name, fmt::join(places, ", ")),
       kRemeshHint);
}

/// Corner classes that hold in every source.
std::vector<int> joint_corners(const std::vector<SourceMesh>& sources) {
  const std::vector<int> first = welded_corners(sources[0]);
  std::vector<int> joint = common_refinement(first, first);
  for (std::size_t s = 1; s < sources.size(); ++s) {
    check_triangle_counts(sources[0], sources[s]);
    const std::vector<int> corners = welded_corners(sources[s]);
    if (!same_vertex_order(sources[0], sources[s])) {
      check_same_topology(sources[0], sources[s], first, corners);
    }
    joint = common_refinement(joint, corners);
  }
  return joint;
}

bool is_degenerate(const int* t) { return t[0] == t[1] || t[1] == t[2] || t[2] == t[0]; }

/// Triangles over corner classes without the degenerate ones; classes that only those used are
/// dropped.
Connectivity compact_connectivity(std::vector<int>& corners, int& dropped_triangles) {
  const std::size_t triangle_count = corners.size() / 3;
  std::vector<int> number(corners.size(), -1);  // corner class -> vertex of K
  Connectivity connectivity;
  std::vector<int> kept;
  for (std::size_t f = 0; f < triangle_count; ++f) {
    const int* t = corners.data() + 3 * f;
    if (is_degenerate(t)) continue;
    for (int k = 0; k < 3; ++k) {
      int& vertex = number[static_cast<std::size_t>(t[k])];
      if (vertex < 0) vertex = connectivity.vertex_count++;
      kept.push_back(vertex);
    }
  }
  dropped_triangles = static_cast<int>(triangle_count - kept.size() / 3);
  connectivity.triangles =
      Eigen::Map<const Triangles>(kept.data(), static_cast<Eigen::Index>(kept.size() / 3), 3);
  for (int& corner : corners) corner = number[static_cast<std::size_t>(corner)];
  return connectivity;
}

/// Render vertex of the first source for every corner of K; `corners` holds K's vertices.
std::vector<int> render_corners(const SourceMesh& first, const std::vector<int>& corners) {
  std::vector<int> render;
  for (std::size_t f = 0; f < corners.size() / 3; ++f) {
    if (is_degenerate(corners.data() + 3 * f)) continue;
    for (std::size_t k = 0; k < 3; ++k) render.push_back(first.triangles.data()[3 * f + k]);
  }
  return render;
}

void turn_winding(MorphableMesh& mesh) {
  mesh.connectivity.triangles.col(1).swap(mesh.connectivity.triangles.col(2));
  for (std::size_t f = 0; f < mesh.render_of_corner.size() / 3; ++f) {
    std::swap(mesh.render_of_corner[3 * f + 1], mesh.render_of_corner[3 * f + 2]);
  }
}

std::string place_of(const Positions& positions, int vertex) {
  return fmt::format("({:.4g}, {:.4g}, {:.4g})", positions(vertex, 0), positions(vertex, 1),
                     positions(vertex, 2));
}

void check_manifold(const SourceMesh& source, const MorphableMesh& mesh) {
  const ManifoldDefects defects = find_manifold_defects(mesh.connectivity, kPlaces);
  if (defects.none()) return;
  const Positions& positions = mesh.geometries[0];
  std::vector<std::string> places;
  for (const Eigen::Vector2i& edge : defects.crowded_edges) {
    places.push_back(fmt::format("edge {} - {} has more than two triangles",
                                 place_of(positions, edge(0)), place_of(positions, edge(1))));
  }
  for (const int f : defects.misoriented_triangles) {
    places.push_back(fmt::format("the triangle at {} is turned against its neighbour",
                                 place_of(positions, mesh.connectivity.triangles(f, 0))));
  }
  for (const int v : defects.pinched_vertices) {
    places.push_back(fmt::format("the surface is pinched at {}", place_of(positions, v)));
  }
  fail(source, "connectivity.not-manifold",
       fmt::format("the surface is no oriented manifold: {}", fmt::join(places, "; ")),
       "in Blender: Mesh > Clean Up > Merge by Distance, then Select > All by Trait > Non Manifold "
       "shows the places");
}

}  // namespace

MorphableMesh share_connectivity(const std::vector<SourceMesh>& sources) {
  const SourceMesh& first = sources.front();
  MorphableMesh mesh;
  std::vector<int> corners = joint_corners(sources);
  mesh.connectivity = compact_connectivity(corners, mesh.dropped_triangles);
  if (mesh.connectivity.vertex_count == 0) {
    fail(first, "connectivity.empty", "the mesh has no triangle with three different corners",
         "export a mesh that has a surface");
  }
  mesh.vertex_of_render.assign(static_cast<std::size_t>(first.positions.rows()), -1);
  for (const SourceMesh& source : sources) {
    mesh.names.push_back(source.name);
    Positions& geometry = mesh.geometries.emplace_back(mesh.connectivity.vertex_count, 3);
    for (std::size_t c = 0; c < corners.size(); ++c) {
      if (corners[c] >= 0)
        geometry.row(corners[c]) = source.positions.row(source.triangles.data()[c]);
    }
  }
  for (std::size_t c = 0; c < corners.size(); ++c) {
    const int render = first.triangles.data()[c];
    if (corners[c] >= 0) mesh.vertex_of_render[static_cast<std::size_t>(render)] = corners[c];
  }
  mesh.render_of_corner = render_corners(first, corners);
  // A mirroring node turns the winding (glTF 2.0, 3.7.4); K is wound as it is seen in the scene.
  const bool mirrored = first.geometry.to_scene.topLeftCorner<3, 3>().determinant() < 0;
  if (mirrored) turn_winding(mesh);
  check_manifold(first, mesh);
  return mesh;
}

}  // namespace morphbake
