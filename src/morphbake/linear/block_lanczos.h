#pragma once

#include <Eigen/Core>
#include <functional>

namespace morphbake {

/// A symmetric matrix times a block of columns.
using BlockOperator = std::function<Eigen::MatrixXd(const Eigen::MatrixXd&)>;

struct BlockLanczosOptions {
  double tolerance = 1e-12;  ///< residual of a pair relative to its value
  Eigen::Index room = 0;     ///< columns that the subspace may take
};

/// Approximate eigenpairs, the largest value first.
struct RitzPairs {
  Eigen::VectorXd values;
  Eigen::MatrixXd vectors;     ///< orthonormal
  Eigen::VectorXd residuals;   ///< |A v - theta v|
  Eigen::Index converged = 0;  ///< how many of the first are within the tolerance
};

/// The `wanted` largest eigenpairs of A in the Krylov space of a block of columns, which grows
/// until they have converged or there is no more room.
///
/// Every block is made orthogonal to all before it, twice. A block of b columns finds all vectors
/// of eigenvalues that occur up to b times, and costs one pass over a factor.
/// @param start  #X by b, of full rank
/// @see   Golub and Underwood 1977
RitzPairs block_lanczos(const BlockOperator& A, const Eigen::MatrixXd& start, Eigen::Index wanted,
                        const BlockLanczosOptions& options);

}  // namespace morphbake
