#pragma once

#include <Eigen/Core>
#include <Eigen/SparseCore>

namespace morphbake {

/// Side by side in memory: a row's three coordinates are one cache line.
using ThreeColumns = Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor>;

/// (b - sum of the off-diagonal entries times x) / diagonal of one row.
inline Eigen::RowVector3d relaxed_row(const Eigen::SparseMatrix<double>& A, const ThreeColumns& b,
                                      const ThreeColumns& x, Eigen::Index row) {
  Eigen::RowVector3d sum = b.row(row);
  double diagonal = 1;
  // The matrix is symmetric: its column is the row.
  for (Eigen::SparseMatrix<double>::InnerIterator entry(A, row); entry; ++entry) {
    if (entry.row() == row) {
      diagonal = entry.value();
    } else {
      sum -= entry.value() * x.row(entry.row());
    }
  }
  return sum / diagonal;
}

}  // namespace morphbake
