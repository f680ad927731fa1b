#pragma once

#include <Eigen/Core>
#include <vector>

namespace morphbake {

/// The pairs of rows and columns of least total cost, where leaving one alone costs too.
///
/// @param cost   #rows by #columns, finite
/// @param alone  cost of a row or column without partner
/// @return       one a row: its column, or -1
/// @cost         O((rows + columns)^3)
/// @see          Kuhn 1955; Jonker and Volgenant 1987
std::vector<int> assign(const Eigen::MatrixXd& cost, double alone);

}  // namespace morphbake
