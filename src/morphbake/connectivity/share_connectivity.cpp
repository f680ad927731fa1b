#include <algorithm>
#include <utility>

#include "morphbake/connectivity/mismatch.h"
#include "morphbake/connectivity/morphable_mesh.h"
#include "morphbake/sources/corner_surface.h"

namespace morphbake {
namespace {

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

/// Corner classes that hold in every source.
std::vector<int> joint_corners(const std::vector<SourceMesh>& sources) {
  const std::vector<int> first = welded_corners(sources[0]);
  std::vector<int> joint = common_refinement(first, first);
  for (std::size_t s = 1; s < sources.size(); ++s) {
    const TopologyMismatch mismatch = find_mismatch(sources[0], sources[s]);
    if (mismatch.any()) throw BakeError(mismatch_problem(sources[0], sources[s], mismatch));
    joint = common_refinement(joint, welded_corners(sources[s]));
  }
  return joint;
}

}  // namespace

MorphableMesh share_connectivity(const std::vector<SourceMesh>& sources) {
  const SourceMesh& first = sources.front();
  const CornerSurface surface = surface_of_corners(first, joint_corners(sources));
  MorphableMesh mesh;
  mesh.connectivity = surface.connectivity;
  mesh.triangle_of_file = surface.triangle_of_file;
  mesh.repairs = surface.repairs;
  mesh.render_of_corner = render_corners(first, surface);
  mesh.vertex_of_render = vertices_of_render(first, surface);
  for (const SourceMesh& source : sources) {
    mesh.names.push_back(source.name);
    mesh.geometries.push_back(vertex_positions(source, surface));
  }
  check_manifold(first, mesh.connectivity, mesh.geometries[0]);
  return mesh;
}

}  // namespace morphbake
