#pragma once

#include <Eigen/SparseCholesky>

struct cholmod_common_struct;
struct cholmod_factor_struct;

namespace morphbake::bench {

/// A matrix without its first row and column, which make K_L singular: both triangles.
Eigen::SparseMatrix<double> grounded(const Eigen::SparseMatrix<double>& matrix);

/// CHOLMOD's factor and its own solve, as its users write it.
class PlainCholmod {
 public:
  explicit PlainCholmod(const Eigen::SparseMatrix<double>& matrix);
  ~PlainCholmod();
  PlainCholmod(const PlainCholmod&) = delete;
  PlainCholmod& operator=(const PlainCholmod&) = delete;

  /// @param b  rows by any number of columns
  void solve(Eigen::MatrixXd& b) const;

 private:
  cholmod_common_struct* common_;
  cholmod_factor_struct* factor_;
};

}  // namespace morphbake::bench
