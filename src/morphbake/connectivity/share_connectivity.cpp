#include <fmt/core.h>
#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <utility>

#include "morphbake/connectivity/morphable_mesh.h"
#include "morphbake/sources/corner_surface.h"

namespace morphbake {
namespace {

constexpr int kPlaces = 3;  // how many places a message names

constexpr const char* kRemeshHint =
    "give them new triangles that fit all: \"connectivity\": {\"mode\": \"remesh\"}; or export "
    "poses or sculpts of one mesh alike";

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
  fail_source(other, "connectivity.different-triangles",
              fmt::format("\"{}\" has {} triangles but \"{}\" has {}", other.name,
                          other.triangles.rows(), first.name, first.triangles.rows()),
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
  fail_source(other, "connectivity.different-topology",
              fmt::format("\"{}\" and \"{}\" are not connected alike: first at triangles {}",
                          other.name, first.name, fmt::join(places, ", ")),
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

}  // namespace

MorphableMesh share_connectivity(const std::vector<SourceMesh>& sources) {
  const SourceMesh& first = sources.front();
  const std::vector<int> classes = joint_corners(sources);
  CornerSurface surface = surface_of_corners(classes, proper_triangles(classes));
  wind_as_seen(first, surface);
  MorphableMesh mesh;
  mesh.connectivity = surface.connectivity;
  mesh.dropped_triangles =
      static_cast<int>(first.triangles.rows() - surface.connectivity.triangles.rows());
  mesh.render_of_corner = render_corners(first, surface);
  mesh.vertex_of_render.assign(static_cast<std::size_t>(first.positions.rows()), -1);
  for (const SourceMesh& source : sources) {
    mesh.names.push_back(source.name);
    mesh.geometries.push_back(vertex_positions(source, surface));
  }
  for (std::size_t c = 0; c < surface.vertex_of_corner.size(); ++c) {
    const int vertex = surface.vertex_of_corner[c];
    const auto render = static_cast<std::size_t>(first.triangles.data()[c]);
    if (vertex >= 0) mesh.vertex_of_render[render] = vertex;
  }
  check_manifold(first, mesh.connectivity, mesh.geometries[0]);
  return mesh;
}

}  // namespace morphbake
