#pragma once

#include <Eigen/SparseCore>
#include <memory>
#include <vector>

#include "morphbake/mesh/adjacency.h"

namespace morphbake {

/// A Cholesky factor of K_L, made once and used for every right-hand side.
///
/// K_L is singular: one constant a component. The first vertex of each component is set to 0 and
/// its equation left out. That is exact when the right-hand side sums to 0 over the component,
/// which blend_edge_differences guarantees; the caller adds the translation that it wants.
class LaplacianFactor {
 public:
  /// @param K_L         #V by #V, symmetric_laplacian
  /// @param components  of the same connectivity
  /// @throws BakeError "linear.out-of-memory", "linear.not-definite"
  /// @cost   O(#V^1.5) flops, 350-570 bytes a vertex; one thread
  LaplacianFactor(const Eigen::SparseMatrix<double>& K_L, const Components& components);
  LaplacianFactor(LaplacianFactor&&) noexcept;
  LaplacianFactor& operator=(LaplacianFactor&&) noexcept;
  ~LaplacianFactor();

  /// @param b  #V by any number of columns; each column sums to 0 over every component
  /// @return   X with K_L X = b and 0 in the first vertex of each component: as b
  Eigen::MatrixXd solve(const Eigen::MatrixXd& b) const;

 private:
  struct Cholmod;
  std::unique_ptr<Cholmod> cholmod_;
};

}  // namespace morphbake
