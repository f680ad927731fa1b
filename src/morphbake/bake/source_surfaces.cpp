#include "morphbake/bake/source_surfaces.h"

#include <algorithm>
#include <array>
#include <cassert>

#include "morphbake/connectivity/morphable_mesh.h"
#include "morphbake/transition/surface_distance.h"

namespace morphbake {
namespace {

using Corners = std::array<int, 3>;

Corners sorted(Corners corners) {
  std::sort(corners.begin(), corners.end());
  return corners;
}

Corners corners_of(const std::vector<int>& render_of_corner, std::size_t f) {
  return {render_of_corner[3 * f], render_of_corner[3 * f + 1], render_of_corner[3 * f + 2]};
}

/// `render_of_corner` of another source that shares the first one's triangles: the corners of the
/// same file triangle.
std::vector<int> same_corners(const SourceMesh& first, const std::vector<int>& of_first,
                              const std::vector<int>& in_file, const SourceMesh& other) {
  std::vector<int> result;
  for (std::size_t c = 0; c < of_first.size(); ++c) {
    const int f = in_file[c / 3];
    int k = 0;
    while (first.triangles(f, k) != of_first[c]) ++k;
    result.push_back(other.triangles(f, k));
  }
  return result;
}

void add_landmarks(const SourceRef& ref, SourceSurface& surface) {
  for (const NamedPosition& landmark : ref.landmarks) {
    surface.landmark_names.push_back(landmark.name);
    surface.landmarks.push_back(closest_point(surface.mesh, landmark.position));
  }
}

}  // namespace

std::vector<SourceSurface> shared_surfaces(const Recipe& recipe,
                                           const std::vector<SourceMesh>& sources) {
  const MorphableMesh shared = share_connectivity(sources);
  std::vector<SourceSurface> surfaces;
  std::vector<int> in_file;
  for (std::size_t s = 0; s < sources.size(); ++s) {
    SourceSurface& surface = surfaces.emplace_back();
    surface.name = sources[s].name;
    surface.file = recipe.sources[s].file.string();
    surface.mesh = {shared.geometries[s], shared.connectivity.triangles};
    surface.render_of_corner = shared.render_of_corner;
    if (s == 0) {
      in_file = triangles_in_file(surface, sources[0]);
    } else {
      surface.render_of_corner =
          same_corners(sources[0], shared.render_of_corner, in_file, sources[s]);
    }
    surface.vertex_of_render.assign(static_cast<std::size_t>(sources[s].positions.rows()), -1);
    for (std::size_t c = 0; c < surface.render_of_corner.size(); ++c) {
      surface.vertex_of_render[static_cast<std::size_t>(surface.render_of_corner[c])] =
          surface.mesh.triangles.data()[c];
    }
    add_landmarks(recipe.sources[s], surface);
  }
  return surfaces;
}

std::vector<int> triangles_in_file(const SourceSurface& surface, const SourceMesh& source) {
  std::vector<int> in_file;
  int at = 0;
  for (std::size_t f = 0; f < surface.render_of_corner.size() / 3; ++f) {
    const Corners wanted = sorted(corners_of(surface.render_of_corner, f));
    const auto corners = [&] {
      return sorted({source.triangles(at, 0), source.triangles(at, 1), source.triangles(at, 2)});
    };
    while (corners() != wanted) ++at;  // triangles that the surface dropped
    assert(at < source.triangles.rows());
    in_file.push_back(at++);
  }
  return in_file;
}

}  // namespace morphbake
