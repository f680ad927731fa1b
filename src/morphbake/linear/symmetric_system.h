#pragma once

#include <Eigen/SparseCore>
#include <vector>

namespace morphbake {

/// Columns whose rows lie together: what belongs to one unknown is read at once.
using ColumnRows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// A symmetric positive semi-definite matrix that sees everything but the constants on some blocks.
///
/// K_L of a component that nothing holds is such a block; a held component's matrix is definite.
struct SymmetricSystem {
  Eigen::SparseMatrix<double> matrix;  ///< #X by #X, both triangles
  std::vector<int> singular_block;     ///< #X: which block whose constants it maps to 0, or -1
  int singular_block_count = 0;
};

/// The mean of each column over each singular block: #blocks by #columns.
ColumnRows block_means(const SymmetricSystem& system, const ColumnRows& columns);

/// Takes these means away: what is left is in the matrix's range.
void remove_block_means(const SymmetricSystem& system, Eigen::MatrixXd& columns);
void remove_block_means(const SymmetricSystem& system, ColumnRows& columns);

/// How an iteration ended.
struct Convergence {
  int iterations = 0;
  double residual = 0;  ///< |A X - B| / |B|, Frobenius norms; |A X - B| where B is 0
  double error = 0;     ///< estimate of the largest distance of a row of X from the solution
  bool reached = false;
};

}  // namespace morphbake
