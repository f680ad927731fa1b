#include "morphbake/connectivity/map_distortion.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numeric>
#include <utility>

#include "morphbake/mesh/measures.h"

namespace morphbake {
namespace {

constexpr double kLargest = 1e12;  // larger distortions say no more, and infinity is no JSON

/// Edges a -> b and a -> c of a triangle in its own plane: columns (x, 0) and (y, z).
Eigen::Matrix2d flattened(const Positions& positions, const Triangles& triangles, int f) {
  const Eigen::RowVector3d a = positions.row(triangles(f, 0));
  const Eigen::RowVector3d ab = positions.row(triangles(f, 1)) - a;
  const Eigen::RowVector3d ac = positions.row(triangles(f, 2)) - a;
  const double length = ab.norm();
  if (!(length > 0)) return Eigen::Matrix2d::Zero();
  Eigen::Matrix2d plane;
  plane << length, ac.dot(ab) / length, 0, ab.cross(ac).norm() / length;
  return plane;
}

/// Smallest value that the share `percent` of all weight does not exceed.
double percentile(const std::vector<std::pair<double, double>>& sorted, double total,
                  double percent) {
  double sum = 0;
  for (const auto& [value, weight] : sorted) {
    sum += weight;
    if (sum >= total * percent / 100) return value;
  }
  return sorted.empty() ? 1 : sorted.back().first;
}

/// Label of the connected set (over edges) of each marked triangle, -1 for others.
std::vector<int> label_sets(const Triangles& triangles, const std::vector<char>& marked,
                            int& count) {
  std::vector<int> parent(marked.size());
  std::iota(parent.begin(), parent.end(), 0);
  const auto root = [&](int f) {
    while (parent[static_cast<std::size_t>(f)] != f) f = parent[static_cast<std::size_t>(f)];
    return f;
  };
  std::map<std::pair<int, int>, int> triangle_at;
  for (int f = 0; f < triangles.rows(); ++f) {
    if (marked[static_cast<std::size_t>(f)] == 0) continue;
    for (int k = 0; k < 3; ++k) {
      const int a = triangles(f, k), b = triangles(f, (k + 1) % 3);
      const auto [entry, is_new] = triangle_at.try_emplace({std::min(a, b), std::max(a, b)}, f);
      if (is_new) continue;
      const auto [low, high] = std::minmax({root(entry->second), root(f)});
      parent[static_cast<std::size_t>(high)] = low;
    }
  }
  std::vector<int> labels(marked.size(), -1);
  count = 0;
  for (std::size_t f = 0; f < marked.size(); ++f) {
    if (marked[f] == 0) continue;
    const int first = root(static_cast<int>(f));  // the set's lowest triangle comes first
    labels[f] = first == static_cast<int>(f) ? count++ : labels[static_cast<std::size_t>(first)];
  }
  return labels;
}

/// @param diagonal  of the first source
/// @return  the landmark's number, or -1
int name_nearest_landmark(const SharedTriangulation& triangulation, double diagonal,
                          const std::vector<std::string>& names, DistortionRegion& region) {
  const Positions& positions = triangulation.geometries[0];
  int nearest = -1;
  for (std::size_t i = 0; i < names.size(); ++i) {
    const double distance =
        (positions.row(triangulation.landmarks[i]) - region.centre).norm() / diagonal;
    if (!region.nearest_landmark.empty() && !(distance < region.landmark_distance)) continue;
    region.nearest_landmark = names[i];
    region.landmark_distance = distance;
    nearest = static_cast<int>(i);
  }
  return nearest;
}

/// A region of the map to `other`: its triangles, and the vertex of the landmark nearest to it.
struct RegionPlace {
  std::size_t other = 0;
  std::vector<int> triangles;
  int landmark = 0;
};

/// Finds the point of the region furthest from its landmark: there a part ends that sticks out.
void find_end(const SharedTriangulation& triangulation, const RegionPlace& place,
              const std::array<double, 2>& diagonals, DistortionRegion& region) {
  for (const std::size_t side : {std::size_t{0}, std::size_t{1}}) {
    const Positions& positions = triangulation.geometries[side == 0 ? 0 : place.other];
    const Eigen::RowVector3d from = positions.row(place.landmark);
    for (const int f : place.triangles) {
      for (int k = 0; k < 3; ++k) {
        const Eigen::RowVector3d at = positions.row(triangulation.connectivity.triangles(f, k));
        const double distance = (at - from).norm() / diagonals[side];
        if (!(distance > region.end_distance)) continue;
        region.end_distance = distance;
        region.end = at;
        region.ends_on_other = side == 1;
      }
    }
  }
}

}  // namespace

Eigen::VectorXd map_distortion(const Positions& from, const Positions& to,
                               const Triangles& triangles) {
  const double scale =
      std::sqrt(triangle_areas(from, triangles).sum() / triangle_areas(to, triangles).sum());
  Eigen::VectorXd distortion(triangles.rows());
  for (int f = 0; f < triangles.rows(); ++f) {
    const Eigen::Matrix2d a = flattened(from, triangles, f);
    const Eigen::Matrix2d b = scale * flattened(to, triangles, f);
    const double area_a = a(0, 0) * a(1, 1), area_b = b(0, 0) * b(1, 1);
    Eigen::Matrix2d inverse;
    inverse << a(1, 1), -a(0, 1), 0, a(0, 0);
    const double squares = (b * inverse / area_a).squaredNorm();
    const double stretch = area_b / area_a;
    const double energy = squares * (1 + 1 / (stretch * stretch)) / 4;
    distortion(f) = energy < kLargest ? std::max(energy, 1.0) : kLargest;  // NaN is large too
  }
  return distortion;
}

MapQuality summarize_distortion(const Eigen::VectorXd& distortion, const Eigen::VectorXd& areas) {
  std::vector<std::pair<double, double>> sorted;
  for (Eigen::Index f = 0; f < areas.size(); ++f) sorted.emplace_back(distortion(f), areas(f));
  std::sort(sorted.begin(), sorted.end());
  const double total = areas.sum();
  MapQuality quality;
  quality.mean = distortion.dot(areas) / total;
  quality.median = percentile(sorted, total, 50);
  quality.percentile_95 = percentile(sorted, total, 95);
  quality.percentile_99 = percentile(sorted, total, 99);
  quality.maximum = distortion.maxCoeff();
  return quality;
}

std::vector<DistortionRegion> find_distortion_regions(const SharedTriangulation& triangulation,
                                                      std::size_t other,
                                                      const std::vector<std::string>& names) {
  const Triangles& triangles = triangulation.connectivity.triangles;
  const Positions& positions = triangulation.geometries[0];
  const Eigen::VectorXd distortion =
      map_distortion(positions, triangulation.geometries[other], triangles);
  const Eigen::VectorXd areas = triangle_areas(positions, triangles);
  const Eigen::VectorXd other_areas = triangle_areas(triangulation.geometries[other], triangles);
  const double area = areas.sum(), other_area = other_areas.sum();
  const std::array<double, 2> diagonals = {bounding_diagonal(positions),
                                           bounding_diagonal(triangulation.geometries[other])};
  std::vector<char> marked;
  for (const double value : distortion) marked.push_back(value > kHighDistortion ? 1 : 0);
  int count = 0;
  const std::vector<int> labels = label_sets(triangles, marked, count);
  std::vector<DistortionRegion> regions(static_cast<std::size_t>(count));
  std::vector<RegionPlace> places(regions.size());
  for (int f = 0; f < triangles.rows(); ++f) {
    const int label = labels[static_cast<std::size_t>(f)];
    if (label < 0) continue;
    auto& region = regions[static_cast<std::size_t>(label)];
    places[static_cast<std::size_t>(label)].triangles.push_back(f);
    ++region.triangles;
    region.area_share += areas(f) / area;
    region.other_area_share += other_areas(f) / other_area;
    for (int k = 0; k < 3; ++k) region.centre += positions.row(triangles(f, k));
  }
  for (std::size_t r = 0; r < regions.size(); ++r) {
    DistortionRegion& region = regions[r];
    region.centre /= 3 * region.triangles;
    const int landmark = name_nearest_landmark(triangulation, diagonals[0], names, region);
    if (landmark < 0) continue;
    places[r].other = other;
    places[r].landmark = triangulation.landmarks[static_cast<std::size_t>(landmark)];
    find_end(triangulation, places[r], diagonals, region);
  }
  std::stable_sort(regions.begin(), regions.end(),
                   [](const auto& a, const auto& b) { return a.area_share > b.area_share; });
  return regions;
}

}  // namespace morphbake
