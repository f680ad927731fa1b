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
constexpr double kHausdorffBound = 1e-4;  // fraction of the diagonal by which it may be too small
constexpr std::size_t kListedRegions = 20;

Eigen::RowVector3d face_normal(const Mesh& mesh, int f) {
  const Eigen::RowVector3d a = mesh.positions.row(mesh.triangles(f, 0));
  const Eigen::RowVector3d b = mesh.positions.row(mesh.triangles(f, 1));
  const Eigen::RowVector3d c = mesh.positions.row(mesh.triangles(f, 2));
  return (b - a).cross(c - a);
}

/// The source's triangle nearest to the middle of each triangle.
std::vector<int> triangles_below(const Mesh& source, const Mesh& remesh) {
  Positions centres = Positions::Zero(remesh.triangles.rows(), 3);
  for (int f = 0; f < remesh.triangles.rows(); ++f) {
    for (int k = 0; k < 3; ++k) centres.row(f) += remesh.positions.row(remesh.triangles(f, k)) / 3;
  }
  std::vector<int> below;
  for (const SurfacePoint& point : closest_points(source, centres)) below.push_back(point.triangle);
  return below;
}

/// Sum of the unit normals of a source where the corners of a triangle lie on it.
Eigen::RowVector3d normal_at_corners(const Mesh& source, const std::vector<SurfacePoint>& on_source,
                                     const Eigen::RowVector3i& corners) {
  Eigen::RowVector3d sum = Eigen::RowVector3d::Zero();
  for (const int v : corners) {
    sum += face_normal(source, on_source[static_cast<std::size_t>(v)].triangle).normalized();
  }
  return sum;
}

/// The nearest surface alone would not do: where two sheets lie close to one another, as lips do,
/// it may be the other one.
int count_folds(const Mesh& source, const std::vector<SurfacePoint>& on_source, const Mesh& remesh,
                const std::vector<int>& below) {
  int folds = 0;
  for (int f = 0; f < remesh.triangles.rows(); ++f) {
    const Eigen::RowVector3d normal = face_normal(remesh, f);
    const int under = below[static_cast<std::size_t>(f)];
    folds += normal.dot(face_normal(source, under)) < 0 &&
             normal.dot(normal_at_corners(source, on_source, remesh.triangles.row(f))) < 0;
  }
  return folds;
}

/// Pairs that do not both lie where the source's own triangles cut one another.
int count_new(const std::vector<std::pair<int, int>>& pairs, const Mesh& source,
              const std::vector<int>& below) {
  if (pairs.empty()) return 0;
  const std::vector<char> near_cuts = triangles_near_cuts(source);
  const auto is_near = [&](int f) {
    return near_cuts[static_cast<std::size_t>(below[static_cast<std::size_t>(f)])] != 0;
  };
  return static_cast<int>(std::count_if(pairs.begin(), pairs.end(), [&](const auto& pair) {
    return !is_near(pair.first) || !is_near(pair.second);
  }));
}

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
                             const SharedTriangulation& triangulation, std::size_t s) {
  const SourceSurface& source = surfaces[s];
  const Mesh remesh{triangulation.geometries[s], triangulation.connectivity.triangles};
  const double diagonal = bounding_diagonal(source.mesh.positions);
  const double bound = kHausdorffBound * diagonal;
  SourceQuality quality;
  quality.source = source.name;
  quality.source_to_remesh = hausdorff_distance(source.mesh, remesh, bound) / diagonal;
  quality.remesh_to_source = hausdorff_distance(remesh, source.mesh, bound) / diagonal;
  const std::vector<int> below = triangles_below(source.mesh, remesh);
  quality.folds = count_folds(source.mesh, triangulation.on_source[s], remesh, below);
  const std::vector<std::pair<int, int>> pairs = self_intersections(remesh);
  quality.self_intersections = static_cast<int>(pairs.size());
  quality.new_self_intersections = count_new(pairs, source.mesh, below);
  quality.source_self_intersections = static_cast<int>(self_intersections(source.mesh).size());
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
    quality.sources.push_back(measure_source(surfaces, triangulation, s));
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
