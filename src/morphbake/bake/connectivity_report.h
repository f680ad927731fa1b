#pragma once

#include <optional>
#include <string>
#include <vector>

#include "morphbake/bake/stage_report.h"
#include "morphbake/connectivity/measure_triangulation.h"
#include "morphbake/connectivity/shared_triangulation.h"
#include "morphbake/diagnostics/problem.h"
#include "morphbake/recipe/recipe.h"
#include "morphbake/sources/corner_surface.h"

namespace morphbake {

struct SourceRepairs {
  std::string source;
  SurfaceRepairs repairs;
};

/// The texture of a new connectivity.
struct TextureReport {
  int size = 0;        ///< texels of a side
  int charts = 0;      ///< parts into which the surface is cut
  double covered = 0;  ///< share of the texture that shows the surface
};

/// How the sources got one connectivity.
struct ConnectivityReport {
  ConnectivityMode mode = ConnectivityMode::Shared;
  int vertices = 0;
  int triangles = 0;
  std::vector<SourceRepairs> repairs;    ///< one a source; those that share triangles share it
  std::vector<StageReport> steps;        ///< none when the sources shared one
  std::optional<TextureReport> texture;  ///< when there is one
  std::optional<TriangulationQuality> quality;  ///< of new triangles, when it was measured
};

/// What is worth a look in a new connectivity, at most one warning of each kind a source.
///
/// Where it has max_vertices vertices, refinement ended there.
std::vector<Problem> connectivity_warnings(const Recipe& recipe,
                                           const SharedTriangulation& triangulation,
                                           const TriangulationQuality& quality);

/// What helps a region of high distortion: "add a landmark ...".
///
/// @param first  name of the first source
std::string advice_for(const DistortionRegion& region, const std::string& first);

}  // namespace morphbake
