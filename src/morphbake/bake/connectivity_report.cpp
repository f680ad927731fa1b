#include "morphbake/bake/connectivity_report.h"

#include <fmt/core.h>

#include <algorithm>
#include <utility>

namespace morphbake {
namespace {

constexpr double kLeastShare = 0.001;   // of the area: smaller regions nobody sees
constexpr double kClearlyLonger = 1.5;  // than asked for; relaxing edges lengthens some

Problem warning(const Recipe& recipe, const char* code, std::string message, std::string hint) {
  return {Severity::Warning, code, location_in(recipe, "/connectivity"), std::move(message),
          std::move(hint)};
}

/// What was not reached, and whether max_vertices was why.
void add_size_warnings(const Recipe& recipe, bool ended_by_limit, const SourceQuality& quality,
                       std::vector<Problem>& warnings) {
  const ConnectivityRequest& request = recipe.connectivity;
  const std::string ended =
      ended_by_limit ? fmt::format("; refinement ended at max_vertices ({})", request.max_vertices)
                     : "";
  const double reached = std::max(quality.source_to_remesh, quality.remesh_to_source);
  const bool is_asked_for = request.mode == ConnectivityMode::Remesh ||
                            request.sizing == VertexSizing::Curvature;  // see resample
  if (is_asked_for && reached > request.max_error) {
    warnings.push_back(warning(
        recipe, "connectivity.error-not-reached",
        fmt::format("\"{}\" is met within {:.2g} of its diagonal, not within max_error ({:.2g}){}",
                    quality.source, reached, request.max_error, ended),
        ended_by_limit ? "allow more max_vertices, or a larger max_error"
                       : "a smaller target_edge_length helps, or a larger max_error"));
  }
  if (ended_by_limit && quality.longest_edge > kClearlyLonger * request.target_edge_length) {
    warnings.push_back(warning(
        recipe, "connectivity.edge-length-not-reached",
        fmt::format("edges of \"{}\" are up to {:.2g} of its diagonal long, longer than "
                    "target_edge_length ({:.2g}){}",
                    quality.source, quality.longest_edge, request.target_edge_length, ended),
        "allow more max_vertices, or a larger target_edge_length"));
  }
}

void add_source_warnings(const Recipe& recipe, const SourceQuality& quality,
                         std::vector<Problem>& warnings) {
  if (quality.folds > 0) {
    warnings.push_back(warning(
        recipe, "connectivity.folds",
        fmt::format("{} new triangles of \"{}\" face against its surface", quality.folds,
                    quality.source),
        "more landmarks, at the tips above all, or a smaller target_edge_length help; `morphbake "
        "remesh` draws a sheet of the new triangles"));
  }
  if (quality.new_self_intersections > 0) {
    warnings.push_back(warning(
        recipe, "connectivity.self-intersections",
        fmt::format("{} pairs of new triangles of \"{}\" cut one another where the source's do not",
                    quality.new_self_intersections, quality.source),
        "a smaller max_error keeps thin parts apart"));
  }
}

std::string shown_point(const Eigen::RowVector3d& point) {
  return fmt::format("({:.4g}, {:.4g}, {:.4g})", point(0), point(1), point(2));
}

/// Share of the source on which it is larger. Triangles without area have none.
double largest_share(const DistortionRegion& region) {
  return std::max(region.area_share, region.other_area_share);
}

/// The largest region of the map to a source; null when none is worth a word.
const DistortionRegion* largest_region(const TriangulationQuality& quality,
                                       const std::string& source) {
  const DistortionRegion* largest = nullptr;
  for (const DistortionRegion& region : quality.regions) {
    if (region.source != source || largest_share(region) < kLeastShare) continue;
    if (largest == nullptr || largest_share(region) > largest_share(*largest)) largest = &region;
  }
  return largest;
}

/// @param first  name of the first source
Problem distortion_warning(const Recipe& recipe, const DistortionRegion& region,
                           const std::string& first) {
  return warning(recipe, "connectivity.high-distortion",
                 fmt::format("{} triangles, {:.2g} % of the area of \"{}\" and {:.2g} % of \"{}\", "
                             "are distorted more than {:g} times",
                             region.triangles, 100 * region.area_share, first,
                             100 * region.other_area_share, region.source, kHighDistortion),
                 advice_for(region, first));
}

}  // namespace

std::string advice_for(const DistortionRegion& region, const std::string& first) {
  if (region.nearest_landmark.empty()) {
    return fmt::format(
        "add a landmark on every source; the middle of the region is near {} on \"{}\"",
        shown_point(region.centre), first);
  }
  return fmt::format(
      "add a landmark on every source; the region ends near {} on \"{}\", {:.2g} of the diagonal "
      "from \"{}\"",
      shown_point(region.end), region.ends_on_other ? region.source : first, region.end_distance,
      region.nearest_landmark);
}

std::vector<Problem> connectivity_warnings(const Recipe& recipe,
                                           const SharedTriangulation& triangulation,
                                           const TriangulationQuality& quality) {
  std::vector<Problem> warnings;
  const bool ended_by_limit = triangulation.is_full;
  if (triangulation.rounded_hard_edges > 0) {
    warnings.push_back(warning(
        recipe, "connectivity.rounded-hard-edges",
        fmt::format("{} hard edges of the sources found no room and are "
                    "rounded within max_error",
                    triangulation.rounded_hard_edges),
        ended_by_limit ? "allow more max_vertices" : "a smaller target_edge_length makes room"));
  }
  for (const SourceQuality& source : quality.sources) {
    add_size_warnings(recipe, ended_by_limit, source, warnings);
    add_source_warnings(recipe, source, warnings);
  }
  for (const MapQuality& map : quality.maps) {
    const DistortionRegion* largest = largest_region(quality, map.source);
    if (largest != nullptr) {
      warnings.push_back(distortion_warning(recipe, *largest, quality.sources.front().source));
    }
  }
  return warnings;
}

}  // namespace morphbake
