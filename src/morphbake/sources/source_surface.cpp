#include "morphbake/sources/source_surface.h"

#include <utility>

#include "morphbake/sources/corner_surface.h"
#include "morphbake/sources/hard_edges.h"
#include "morphbake/sources/places.h"

namespace morphbake {

namespace {

/// Whether `check` finds nothing wrong; what it throws is noted.
template <typename Check>
bool passes(const Check& check, std::vector<Problem>& problems) {
  try {
    check();
    return true;
  } catch (const BakeError& error) {
    problems.insert(problems.end(), error.problems().begin(), error.problems().end());
    return false;
  }
}

}  // namespace

SourceSurface source_surface(const SourceMesh& source, const SourceRef& ref,
                             const Observer& observer, std::vector<Problem>& problems) {
  const CornerSurface corners = surface_of_corners(source, welded_corners(source));
  stop_if_cancelled(observer);

  SourceSurface surface;
  surface.name = source.name;
  surface.file = file_of(source.file);
  surface.repairs = corners.repairs;
  for (const Landmark& landmark : ref.landmarks) surface.landmark_names.push_back(landmark.name);
  const Mesh mesh{vertex_positions(source, corners), corners.connectivity.triangles};
  const bool is_manifold =
      passes([&] { check_manifold(source, corners.connectivity, mesh.positions); }, problems) &&
      passes([&] { check_hubs(source, corners.connectivity, mesh.positions); }, problems);
  stop_if_cancelled(observer);
  if (mesh.triangles.rows() > 0) {
    passes([&] { surface.landmarks = landmark_points(source, corners, mesh, ref, observer); },
           problems);
  }
  stop_if_cancelled(observer);
  if (!is_manifold) return surface;
  for (const Problem& warning :
       surface_warnings(source, {source.name}, mesh.triangles, {mesh.positions}, corners.repairs)) {
    report(observer, warning);
  }
  surface.mesh = mesh;
  surface.vertex_of_render = vertices_of_render(source, corners);
  surface.render_of_corner = render_corners(source, corners);
  surface.hard_edges = find_hard_edges(source, corners, surface.mesh);
  return surface;
}

SourceSurface source_surface(const SourceMesh& source, const SourceRef& ref,
                             const Observer& observer) {
  std::vector<Problem> problems;
  SourceSurface surface = source_surface(source, ref, observer, problems);
  if (!problems.empty()) throw BakeError(std::move(problems));
  return surface;
}

}  // namespace morphbake
