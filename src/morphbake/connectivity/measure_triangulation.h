#pragma once

#include <optional>
#include <string>
#include <vector>

#include "morphbake/connectivity/map_distortion.h"
#include "morphbake/connectivity/shared_triangulation.h"
#include "morphbake/diagnostics/observer.h"
#include "morphbake/sources/source_surface.h"

namespace morphbake {

/// How a shared triangulation is on the sphere over which it was made.
struct SphereQuality {
  int flipped_triangles = 0;  ///< by an exact predicate; must be 0
  double covering = 1;        ///< how often the sphere, or its half, is covered; must be 1
};

/// How well a shared triangulation lies on one source.
struct SourceQuality {
  std::string source;
  double source_to_remesh = 0;  ///< Hausdorff distance, fraction of the diagonal
  double remesh_to_source = 0;  ///< Hausdorff distance, fraction of the diagonal
  /// Triangles that face against the surface nearest to their middle and at their corners.
  int folds = 0;
  int self_intersections = 0;         ///< pairs of triangles
  int source_self_intersections = 0;  ///< of the source itself
  int new_self_intersections = 0;     ///< pairs away from the source's own
  double smallest_angle = 0;          ///< degrees
  double longest_edge = 0;            ///< fraction of the diagonal
  double landmark_error = 0;          ///< of the worst landmark, fraction of the diagonal
  std::optional<SphereQuality> sphere;
};

/// What is measured on a shared triangulation; nothing of it is assumed.
struct TriangulationQuality {
  std::vector<SourceQuality> sources;
  std::vector<MapQuality> maps;           ///< from the first source to each other one
  std::vector<DistortionRegion> regions;  ///< at most 20, largest area first
};

/// @param surfaces  those that the triangulation lies on
/// @throws Cancelled
/// @cost   4 s for two sources of 3k and 8k vertices on 7k new ones, 30 s for two of 200k
TriangulationQuality measure_triangulation(const std::vector<SourceSurface>& surfaces,
                                           const SharedTriangulation& triangulation,
                                           const Observer& observer = {});

}  // namespace morphbake
