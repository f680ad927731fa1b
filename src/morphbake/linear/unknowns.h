#pragma once

#include <Eigen/SparseCore>
#include <vector>

#include "morphbake/linear/symmetric_system.h"

namespace morphbake {

/// Which rows are to be solved for, and how they are numbered.
struct Unknowns {
  std::vector<int> of_row;  ///< -1 where the row is known
  std::vector<int> rows;    ///< rising

  Unknowns() = default;

  explicit Unknowns(const std::vector<bool>& is_known);

  /// Takes the columns of unknowns: #rows by #unknowns.
  Eigen::SparseMatrix<double> selection() const;
};

/// One a part: whether all its rows are unknown.
///
/// @param part_of_row  numbers from 0 on
std::vector<bool> unknown_parts(const Unknowns& unknowns, const std::vector<int>& part_of_row,
                                int part_count);

/// Makes each part all of whose rows are unknown a singular block of the system.
void number_singular_blocks(const Unknowns& unknowns, const std::vector<int>& part_of_row,
                            const std::vector<bool>& is_unknown_part, SymmetricSystem& system);

}  // namespace morphbake
