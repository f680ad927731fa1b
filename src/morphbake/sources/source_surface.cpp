#include "morphbake/sources/source_surface.h"

#include "morphbake/sources/corner_surface.h"
#include "morphbake/sources/hard_edges.h"
#include "morphbake/sources/places.h"

namespace morphbake {

SourceSurface source_surface(const SourceMesh& source, const SourceRef& ref,
                             const Observer& observer) {
  const std::vector<int> classes = welded_corners(source);
  CornerSurface corners =
      surface_of_corners(classes, without_duplicates(classes, proper_triangles(classes)));
  wind_as_seen(source, corners);

  SourceSurface surface;
  surface.name = source.name;
  surface.file = file_of(source.file);
  surface.mesh = {vertex_positions(source, corners), corners.connectivity.triangles};
  check_manifold(source, corners.connectivity, surface.mesh.positions);
  surface.vertex_of_render.assign(static_cast<std::size_t>(source.positions.rows()), -1);
  for (std::size_t c = 0; c < corners.vertex_of_corner.size(); ++c) {
    const auto render = static_cast<std::size_t>(source.triangles.data()[c]);
    const int vertex = corners.vertex_of_corner[c];
    if (vertex >= 0) surface.vertex_of_render[render] = vertex;
  }
  surface.render_of_corner = render_corners(source, corners);
  surface.hard_edges = find_hard_edges(source, corners, surface.mesh);
  for (const Landmark& landmark : ref.landmarks) surface.landmark_names.push_back(landmark.name);
  surface.landmarks = landmark_points(source, corners, surface.mesh, ref, observer);
  return surface;
}

}  // namespace morphbake
