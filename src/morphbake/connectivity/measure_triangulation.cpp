#include "morphbake/connectivity/measure_triangulation.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "morphbake/connectivity/surface_checks.h"
#include "morphbake/correspondence/check_map.h"
#include "morphbake/mesh/closest_point.h"
#include "morphbake/mesh/measures.h"

namespace morphbake {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr std::size_t kListedRegions = 20;

double smallest_angle(const Mesh& mesh) {
  double smallest = kPi;
  for (int f = 0; f < mesh.triangles.rows(); ++f) {
    for (int k = 0; k < 3; ++k) {
      const Eigen::RowVector3d at = mesh.positions.row(mesh.triangles(f, k));
      const Eigen::RowVector3d u = mesh.positions.row(mesh.triangles(f, (k + 1) % 3)) - at;
      const Eigen::RowVector3d v = mesh.positions.row(mesh.triangles(f, (k + 2) % 3)) - at;
      smallest = std::min(smallest, std::atan2(u.cross(v).norm(), u.dot(v)));
    }
  }
  return smallest * 180 / kPi;
}

/// Of the landmarks that the source has; `names` are those of the first source.
double landmark_error(const SourceSurface& source, const std::vector<std::string>& names,
                      const Mesh& remesh, const std::vector<int>& landmarks) {
  double worst = 0;
  for (std::size_t i = 0; i < landmarks.size(); ++i) {
    const auto& own = source.landmark_names;
    const auto found = std::find(own.begin(), own.end(), names[i]);
    if (found == own.end()) continue;
    const auto at = static_cast<std::size_t>(found - own.begin());
    const Eigen::Vector3d place = position_of(source.mesh, source.landmarks[at]);
    worst = std::max(worst, (remesh.positions.row(landmarks[i]).transpose() - place).norm());
  }
  return worst;
}

std::optional<SphereQuality> sphere_quality(const SharedTriangulation& triangulation,
                                            std::size_t s) {
  if (triangulation.sphere.size() <= s || triangulation.sphere[s].rows() == 0) return {};
  const Positions& sphere = triangulation.sphere[s];
  const Triangles& triangles = triangulation.connectivity.triangles;
  const bool is_disk =
      std::any_of(triangulation.on_boundary.begin(), triangulation.on_boundary.end(),
                  [](char on) { return on != 0; });
  const SphereCheck check = check_sphere(sphere, triangles, is_disk);
  return SphereQuality{check.turned, check.degree};
}

double longest_edge(const Mesh& mesh) {
  double longest = 0;
  for (Eigen::Index f = 0; f < mesh.triangles.rows(); ++f) {
    for (int k = 0; k < 3; ++k) {
      const int a = mesh.triangles(f, k), b = mesh.triangles(f, (k + 1) % 3);
      longest = std::max(longest, (mesh.positions.row(a) - mesh.positions.row(b)).norm());
    }
  }
  return longest;
}

SourceQuality measure_source(const std::vector<SourceSurface>& surfaces,
                             const SharedTriangulation& triangulation, std::size_t s,
                             const Observer& observer) {
  const SourceSurface& source = surfaces[s];
  const Mesh remesh{triangulation.geometries[s], triangulation.connectivity.triangles};
  const double diagonal = bounding_diagonal(source.mesh.positions);
  const double bound = kHausdorffBound * diagonal;
  SourceQuality quality;
  quality.source = source.name;
  quality.source_to_remesh = hausdorff_distance(source.mesh, remesh, bound, observer) / diagonal;
  quality.remesh_to_source = hausdorff_distance(remesh, source.mesh, bound, observer) / diagonal;
  quality.folds = static_cast<int>(
      folded_triangles(source.mesh, remesh, triangulation.on_source[s], observer).size());
  const std::vector<std::pair<int, int>> pairs = self_intersections(remesh, observer);
  quality.self_intersections = static_cast<int>(pairs.size());
  if (!pairs.empty()) {
    const std::vector<char> near_cuts = triangles_near_cuts(source.mesh, observer);
    quality.new_self_intersections =
        static_cast<int>(new_cuts(pairs, remesh, source.mesh, near_cuts).size());
  }
  quality.source_self_intersections =
      static_cast<int>(self_intersections(source.mesh, observer).size());
  quality.smallest_angle = smallest_angle(remesh);
  quality.longest_edge = longest_edge(remesh) / diagonal;
  quality.landmark_error =
      landmark_error(source, surfaces[0].landmark_names, remesh, triangulation.landmarks) /
      diagonal;
  quality.sphere = sphere_quality(triangulation, s);
  return quality;
}

}  // namespace

TriangulationQuality measure_triangulation(const std::vector<SourceSurface>& surfaces,
                                           const SharedTriangulation& triangulation,
                                           const Observer& observer) {
  const Positions& first = triangulation.geometries[0];
  const Triangles& triangles = triangulation.connectivity.triangles;
  const Eigen::VectorXd areas = triangle_areas(first, triangles);
  const int count = static_cast<int>(surfaces.size());
  TriangulationQuality quality;
  for (std::size_t s = 0; s < surfaces.size(); ++s) {
    advance(observer, {"measure", static_cast<int>(s), count});
    quality.sources.push_back(measure_source(surfaces, triangulation, s, observer));
    stop_if_cancelled(observer);
    if (s == 0) continue;
    quality.maps.push_back(
        summarize_distortion(map_distortion(first, triangulation.geometries[s], triangles), areas));
    quality.maps.back().source = surfaces[s].name;
    for (DistortionRegion& region :
         find_distortion_regions(triangulation, s, surfaces[0].landmark_names)) {
      region.source = surfaces[s].name;
      quality.regions.push_back(std::move(region));
    }
  }
  std::stable_sort(quality.regions.begin(), quality.regions.end(),
                   [](const auto& a, const auto& b) { return a.area_share > b.area_share; });
  if (quality.regions.size() > kListedRegions) quality.regions.resize(kListedRegions);
  return quality;
}

}  // namespace morphbake
