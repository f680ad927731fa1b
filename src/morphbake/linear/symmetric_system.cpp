#include "morphbake/linear/symmetric_system.h"

namespace morphbake {
namespace {

template <class Columns>
void remove_means(const SymmetricSystem& system, Columns& columns) {
  if (system.singular_block_count == 0) return;
  ColumnRows means = ColumnRows::Zero(system.singular_block_count, columns.cols());
  Eigen::VectorXd counts = Eigen::VectorXd::Zero(system.singular_block_count);
  for (Eigen::Index row = 0; row < columns.rows(); ++row) {
    const int block = system.singular_block[static_cast<std::size_t>(row)];
    if (block < 0) continue;
    means.row(block) += columns.row(row);
    counts(block) += 1;
  }
  for (Eigen::Index block = 0; block < means.rows(); ++block) means.row(block) /= counts(block);
  for (Eigen::Index row = 0; row < columns.rows(); ++row) {
    const int block = system.singular_block[static_cast<std::size_t>(row)];
    if (block >= 0) columns.row(row) -= means.row(block);
  }
}

}  // namespace

void remove_block_means(const SymmetricSystem& system, Eigen::MatrixXd& columns) {
  remove_means(system, columns);
}

void remove_block_means(const SymmetricSystem& system, ColumnRows& columns) {
  remove_means(system, columns);
}

}  // namespace morphbake
