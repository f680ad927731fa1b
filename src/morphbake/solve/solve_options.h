#pragma once

#include <string>

#include "morphbake/cache/stage_cache.h"

namespace morphbake {

/// How the linear systems are solved; `auto` says in the report what it took and why.
enum class Solver { Auto, Direct, Warm, ConjugateGradients, GaussSeidel, Jacobi };

/// As options write it: "auto", "direct", "warm", "pcg", "gauss-seidel", "jacobi".
std::string name_of(Solver solver);

/// How differential coordinates are blended where shares vary (docs/method.md).
enum class RightHandSide { Edge, Vertex };

struct SolveOptions {
  Solver solver = Solver::Auto;
  RightHandSide right_hand_side = RightHandSide::Edge;
  /// Largest estimated distance of a vertex from the exact solution, as a fraction of the
  /// bounding-box diagonal.
  double tolerance = 1e-9;
  /// Sweeps or steps of one solve before it counts as not converging.
  int max_iterations = 200000;
  /// GB: systems whose factor would take more are solved by conjugate gradients.
  double memory_limit = 12;
  /// Solves every frame, as the paper does, instead of the few shapes that the timeline separates
  /// into.
  bool every_frame = false;
  /// How many there are to solve: no option of a user's.
  int frames = 1;
  /// Where orders of factors are kept: no option of a user's.
  StageCache orders = {};
};

}  // namespace morphbake
