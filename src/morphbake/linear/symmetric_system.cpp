#include "morphbake/linear/symmetric_system.h"

namespace morphbake {
namespace {

/// Calls `visit(row, block)` for the rows of singular blocks.
template <class Visit>
void for_each_singular_row(const SymmetricSystem& system, const Visit& visit) {
  if (system.singular_block_count == 0) return;
  for (std::size_t row = 0; row < system.singular_block.size(); ++row) {
    const int block = system.singular_block[row];
    if (block >= 0) visit(static_cast<Eigen::Index>(row), block);
  }
}

template <class Columns>
ColumnRows means_of(const SymmetricSystem& system, const Columns& columns) {
  ColumnRows means = ColumnRows::Zero(system.singular_block_count, columns.cols());
  Eigen::VectorXd counts = Eigen::VectorXd::Zero(system.singular_block_count);
  for_each_singular_row(system, [&](Eigen::Index row, int block) {
    means.row(block) += columns.row(row);
    counts(block) += 1;
  });
  for (Eigen::Index block = 0; block < means.rows(); ++block) means.row(block) /= counts(block);
  return means;
}

template <class Columns>
void remove_means(const SymmetricSystem& system, Columns& columns) {
  const ColumnRows means = means_of(system, columns);
  for_each_singular_row(system,
                        [&](Eigen::Index row, int block) { columns.row(row) -= means.row(block); });
}

}  // namespace

ColumnRows block_means(const SymmetricSystem& system, const ColumnRows& columns) {
  return means_of(system, columns);
}

void remove_block_means(const SymmetricSystem& system, Eigen::MatrixXd& columns) {
  remove_means(system, columns);
}

void remove_block_means(const SymmetricSystem& system, ColumnRows& columns) {
  remove_means(system, columns);
}

}  // namespace morphbake
