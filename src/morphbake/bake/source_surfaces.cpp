#include "morphbake/bake/source_surfaces.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <utility>

#include "morphbake/connectivity/morphable_mesh.h"
#include "morphbake/correspondence/source_topology.h"
#include "morphbake/sources/common_landmarks.h"
#include "morphbake/sources/corner_surface.h"
#include "morphbake/sources/hard_edges.h"
#include "morphbake/sources/places.h"

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

/// The shared surface as corners of the files' triangles, which are the same in all of them.
CornerSurface corner_surface(const MorphableMesh& shared, const SourceMesh& first) {
  CornerSurface corners;
  corners.connectivity = shared.connectivity;
  corners.triangle_of_file = shared.triangle_of_file;
  corners.repairs = shared.repairs;
  for (const int render : first.triangles.reshaped<Eigen::RowMajor>()) {
    corners.vertex_of_corner.push_back(shared.vertex_of_render[static_cast<std::size_t>(render)]);
  }
  SourceSurface surface;
  surface.render_of_corner = shared.render_of_corner;
  const std::vector<int> in_file = triangles_in_file(surface, first);
  for (std::size_t c = 0; c < shared.render_of_corner.size(); ++c) {
    const int f = in_file[c / 3];
    int k = 0;
    while (first.triangles(f, k) != shared.render_of_corner[c]) ++k;
    corners.file_corner.push_back(3 * f + k);
  }
  return corners;
}

/// New triangles are made on the first source. What lies at one place there would be one: a sphere
/// that is squashed flat, a mouth that is closed so that its lips are one line.
void check_is_surface(const SourceMesh& source, const MorphableMesh& shared) {
  const Positions& positions = shared.geometries[0];
  int count = 0;
  const std::vector<int> welded = weld_rows(positions, count);
  Positions points(count, 3);
  for (Eigen::Index v = 0; v < positions.rows(); ++v) {
    points.row(welded[static_cast<std::size_t>(v)]) = positions.row(v);
  }
  Connectivity own{count, Triangles(shared.connectivity.triangles.rows(), 3)};
  Eigen::Index rows = 0;
  for (const auto& triangle : shared.connectivity.triangles.rowwise()) {
    auto row = own.triangles.row(rows);
    for (int k = 0; k < 3; ++k) row(k) = welded[static_cast<std::size_t>(triangle(k))];
    if (row(0) != row(1) && row(1) != row(2) && row(2) != row(0)) ++rows;
  }
  own.triangles.conservativeResize(rows, 3);
  check_manifold(source, own, points);
  check_hubs(source, own, points);
}

/// Every landmark is a vertex.
void check_room(const Recipe& recipe, std::size_t landmarks) {
  const int limit = recipe.connectivity.max_vertices;
  if (landmarks <= static_cast<std::size_t>(limit)) return;
  throw BakeError(
      Problem{Severity::Error, "connectivity.too-many-vertices",
              location_in(recipe, "/connectivity/max_vertices"),
              fmt::format("{} landmarks need a vertex each; max_vertices is {}", landmarks, limit),
              "allow more vertices, many times the number of landmarks"});
}

}  // namespace

std::vector<SourceSurface> own_surfaces(const Recipe& recipe,
                                        const std::vector<SourceMesh>& sources,
                                        const Observer& observer) {
  std::vector<SourceSurface> surfaces;
  std::vector<Problem> problems;
  for (std::size_t s = 0; s < sources.size(); ++s) {
    stop_if_cancelled(observer);
    surfaces.push_back(source_surface(sources[s], recipe.sources[s], observer, problems));
  }
  for (Problem& problem : common_landmark_problems(recipe.sources)) {
    if (problem.severity == Severity::Error) problems.push_back(std::move(problem));
  }
  stop_if_cancelled(observer);
  for (Problem& problem : topology_problems(surfaces)) problems.push_back(std::move(problem));
  stop_if_cancelled(observer);
  if (!problems.empty()) throw BakeError(std::move(problems));
  surfaces = with_common_landmarks(std::move(surfaces), recipe.sources, observer);
  check_room(recipe, surfaces.front().landmarks.size());
  return surfaces;
}

std::vector<SourceSurface> shared_surfaces(const Recipe& recipe,
                                           const std::vector<SourceMesh>& sources,
                                           const Observer& observer) {
  const MorphableMesh shared = share_connectivity(sources);
  stop_if_cancelled(observer);
  check_is_surface(sources[0], shared);
  stop_if_cancelled(observer);
  for (const Problem& warning :
       surface_warnings(sources[0], shared.names, shared.connectivity.triangles, shared.geometries,
                        shared.repairs)) {
    report(observer, warning);
  }
  const CornerSurface corners = corner_surface(shared, sources[0]);
  std::vector<SourceSurface> surfaces;
  for (std::size_t s = 0; s < sources.size(); ++s) {
    stop_if_cancelled(observer);
    const SourceRef& ref = recipe.sources[s];
    SourceSurface& surface = surfaces.emplace_back();
    surface.name = sources[s].name;
    surface.file = ref.file.string();
    surface.repairs = shared.repairs;
    surface.mesh = {shared.geometries[s], shared.connectivity.triangles};
    surface.render_of_corner = render_corners(sources[s], corners);
    surface.vertex_of_render.assign(static_cast<std::size_t>(sources[s].positions.rows()), -1);
    for (std::size_t c = 0; c < surface.render_of_corner.size(); ++c) {
      surface.vertex_of_render[static_cast<std::size_t>(surface.render_of_corner[c])] =
          surface.mesh.triangles.data()[c];
    }
    surface.hard_edges = find_hard_edges(sources[s], corners, surface.mesh);
    for (const Landmark& landmark : ref.landmarks) surface.landmark_names.push_back(landmark.name);
    surface.landmarks = landmark_points(sources[s], corners, surface.mesh, ref, observer);
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
