#pragma once

#include <vector>

#include "morphbake/mesh/mesh.h"

namespace morphbake {

struct FixedValue {
  int vertex = 0;
  double value = 0;
};

/// Values that are given at some vertices, and between them bend as little as they can: the least
/// sum of squares of K_L's rows, each over its degree (Laplacian squared, biharmonic).
///
/// Harmonic values, the means of their neighbours, have no limit about a single vertex: the finer
/// the mesh, the more they are the same everywhere but there. These are smooth, but may go beyond
/// the least and the largest that are given.
/// @param fixed  one or more on each component; of several at one vertex the first counts
/// @return       #V
/// @throws BakeError "linear.out-of-memory"
/// @cost         a factorisation, of a matrix with about three times the entries of K_L
/// @see          Alexa 2003, section 2.4, which leaves the interpolation open
Eigen::VectorXd spread_values(const Connectivity& connectivity,
                              const std::vector<FixedValue>& fixed);

}  // namespace morphbake
