#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <functional>
#include <span>
#include <vector>

#include "morphbake/linear/symmetric_system.h"

namespace morphbake {

/// A Cholesky factor P A P^T = L L^T by supernodes: columns beside each other with the same rows
/// below them. Supernode s has the columns [first_column[s], first_column[s + 1]) and the rows
/// rows[row_start[s]] .. rows[row_start[s + 1] - 1], the first of which are its columns; its values
/// are dense from value_start[s] on, column by column.
struct SupernodalFactor {
  std::span<const int> first_column;  ///< #supernodes + 1
  std::span<const int> row_start;     ///< likewise
  std::span<const int> value_start;   ///< likewise
  std::span<const int> rows;
  const double* values = nullptr;
  std::span<const int> order;  ///< row of A at each row of L; rows of A that are not there stay 0
  std::size_t row_count = 0;   ///< of A
  std::function<void(std::size_t)> on_packed;  ///< the first so many values are not read again
};

/// A supernode in tiles of four rows: those of its triangle, then those below.
struct PackedSupernode {
  int first_column = 0;
  int triangle_tiles = 0;
  int tiles = 0;
  std::size_t first_tile = 0;
  std::size_t first_value = 0;
};

/// The numbers of a factor in the order in which a solve reads them, for several columns at once.
///
/// A solve costs what reading the factor twice does, or what is done with each number read: four
/// rows lie beside each other, so that each value of the panel of columns that is loaded serves
/// four, and as many columns are taken at once as registers hold.
/// @tparam Scalar  double or float
template <class Scalar>
class PackedFactor {
 public:
  /// Of a system without unknowns.
  PackedFactor() = default;

  explicit PackedFactor(const SupernodalFactor& factor);

  /// X with A X = b. Columns do not see one another: each has the same bytes beside any others. So
  /// it has on x86 with wide registers and without. May be called from several threads at once.
  ///
  /// @param b  #A by any number of columns; rounded to Scalar
  Eigen::MatrixXd solve(const Eigen::MatrixXd& b) const;

  /// b <- X, of columns whose rows lie together.
  void solve_in_place(ColumnRows& columns) const;

  std::size_t bytes() const;

 private:
  void pack(const SupernodalFactor& factor, std::size_t supernode);
  template <int Vectors>
  void solve_panels(ColumnRows& columns, Eigen::Index first, Eigen::Index last) const;

  std::vector<int> place_;  ///< #A: each row's in the factor, or -1
  std::size_t factored_rows_ = 0;
  std::vector<PackedSupernode> supernodes_;
  std::vector<int> rows_;       ///< four a tile; one behind the last where there is none
  std::vector<Scalar> values_;  ///< a tile: four a column to its left; the triangle's own 4 by 4
};

extern template class PackedFactor<double>;
extern template class PackedFactor<float>;

}  // namespace morphbake
