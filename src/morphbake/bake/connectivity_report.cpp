#include "morphbake/bake/connectivity_report.h"

#include <fmt/core.h>

#include <algorithm>
#include <utility>

namespace morphbake {
namespace {

constexpr double kClearlyLonger = 1.5;  // than asked for; relaxing edges lengthens some

Problem warning(const Recipe& recipe, const char* code, std::string message, std::string hint) {
  return {Severity::Warning,
          code,
          {recipe.file.string(), "/connectivity", 0, 0},
          std::move(message),
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
    warnings.push_back(
        warning(recipe, "connectivity.folds",
                fmt::format("{} new triangles of \"{}\" face against its surface", quality.folds,
                            quality.source),
                "look at the red places of the sheet; landmarks there, or a finer mesh, help"));
  }
  if (quality.new_self_intersections > 0) {
    warnings.push_back(warning(
        recipe, "connectivity.self-intersections",
        fmt::format("{} pairs of new triangles of \"{}\" cut one another where the source's do not",
                    quality.new_self_intersections, quality.source),
        "a smaller max_error keeps thin parts apart"));
  }
}

}  // namespace

std::string advice_for(const DistortionRegion& region) {
  const Eigen::RowVector3d& at = region.centre;
  const std::string place = fmt::format("({:.4g}, {:.4g}, {:.4g})", at(0), at(1), at(2));
  if (region.nearest_landmark.empty()) {
    return fmt::format("add a landmark at the tip near {} on every source", place);
  }
  return fmt::format(
      "add a landmark at the tip near {}, {:.2g} of the diagonal from \"{}\", on every source",
      place, region.landmark_distance, region.nearest_landmark);
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
    const auto largest =
        std::find_if(quality.regions.begin(), quality.regions.end(),
                     [&](const DistortionRegion& region) { return region.source == map.source; });
    if (largest == quality.regions.end()) continue;
    warnings.push_back(warning(
        recipe, "connectivity.high-distortion",
        fmt::format("{} triangles of {:.2g} % of the area are distorted more than {:g} times on "
                    "the way to \"{}\"; the worst triangle {:.3g} times",
                    largest->triangles, 100 * largest->area_share, kHighDistortion, map.source,
                    map.maximum),
        advice_for(*largest)));
  }
  return warnings;
}

}  // namespace morphbake
