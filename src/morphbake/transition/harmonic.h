#pragma once

#include <vector>

#include "morphbake/mesh/mesh.h"

namespace morphbake {

struct FixedValue {
  int vertex = 0;
  double value = 0;
};

/// Values that are given at some vertices and at every other the mean of its neighbours.
///
/// They lie between the least and the largest that are given, to rounding.
/// @param fixed  one or more on each component; of several at one vertex the first counts
/// @return       #V
/// @throws BakeError "linear.out-of-memory"
/// @see          Alexa 2003, section 2.4
Eigen::VectorXd harmonic_values(const Connectivity& connectivity,
                                const std::vector<FixedValue>& fixed);

}  // namespace morphbake
