#pragma once

#include <Eigen/SparseCholesky>
#include <vector>

#include "morphbake/mesh/adjacency.h"

namespace morphbake {

/// Degrees as the spectrum takes them: a vertex without neighbours counts as 1, with eigenvalue 0.
Eigen::VectorXd spectral_degrees(const OneRings& rings);

/// L D L^T = K_L - lambda Deg. Its solves are the inverse of what is singular at the eigenvalues
/// lambda of K_L u = lambda Deg u, and by Sylvester's law of inertia as many pivots are negative as
/// eigenvalues lie below lambda.
class ShiftedFactor {
 public:
  explicit ShiftedFactor(const OneRings& rings);

  /// Without pivoting a vanishing pivot (a regular mesh at 1) makes what is eliminated after it
  /// too large to be trusted, so such a lambda is stepped away from.
  ///
  /// @param lambda  above 0
  /// @return the lambda that was taken: up to 1e-4 above, relative
  /// @throws BakeError "linear.no-eigenvectors" when every try meets such a pivot
  /// @cost   0.3 s at 50k vertices
  double factorise(double lambda);

  /// One a vertex: which of them are negative counts eigenvalues, by component.
  const Eigen::VectorXd& pivots() const { return pivots_; }

  /// X with (K_L - lambda Deg) X = b.
  Eigen::VectorXd solve(const Eigen::VectorXd& b) const { return ldlt_.solve(b); }

 private:
  bool is_sure(double lambda);

  Eigen::SparseMatrix<double> laplacian_;
  Eigen::VectorXd degrees_;
  Eigen::VectorXd pivots_;
  Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> ldlt_;
};

}  // namespace morphbake
