#pragma once

namespace morphbake {

/// Where a shared triangulation has its vertices.
enum class Sizing {
  Curvature,  ///< dense where surfaces are curved, as max_error needs; long edges where flat
  Uniform,    ///< edges of about target_edge_length everywhere, and max_error besides
};

/// How fine a shared triangulation is.
struct RemeshOptions {
  /// Largest distance between a source and its remesh, either way, as a fraction of the source's
  /// diagonal, 1e-5 to 0.1. Smaller is finer.
  double max_error = 0.002;

  int max_vertices = 30000;  ///< 50 to 1000000; refinement ends here, with a warning

  /// Longest edge on any source, as a fraction of its diagonal, 1e-4 to 0.5.
  double target_edge_length = 0.03;

  Sizing sizing = Sizing::Curvature;
};

}  // namespace morphbake
