#include "morphbake/linear/unknowns.h"

namespace morphbake {

Unknowns::Unknowns(const std::vector<bool>& is_known) : of_row(is_known.size(), -1) {
  for (std::size_t row = 0; row < is_known.size(); ++row) {
    if (is_known[row]) continue;
    of_row[row] = static_cast<int>(rows.size());
    rows.push_back(static_cast<int>(row));
  }
}

Eigen::SparseMatrix<double> Unknowns::selection() const {
  Eigen::SparseMatrix<double> selection(static_cast<Eigen::Index>(of_row.size()),
                                        static_cast<Eigen::Index>(rows.size()));
  selection.reserve(Eigen::VectorXi::Ones(selection.cols()));
  for (std::size_t i = 0; i < rows.size(); ++i) {
    selection.insert(rows[i], static_cast<Eigen::Index>(i)) = 1;
  }
  return selection;
}

std::vector<bool> unknown_parts(const Unknowns& unknowns, const std::vector<int>& part_of_row,
                                int part_count) {
  std::vector<bool> is_unknown(static_cast<std::size_t>(part_count), true);
  for (std::size_t row = 0; row < part_of_row.size(); ++row) {
    if (unknowns.of_row[row] < 0) is_unknown[static_cast<std::size_t>(part_of_row[row])] = false;
  }
  return is_unknown;
}

void number_singular_blocks(const Unknowns& unknowns, const std::vector<int>& part_of_row,
                            const std::vector<bool>& is_unknown_part, SymmetricSystem& system) {
  system.singular_block.clear();
  system.singular_block_count = 0;
  std::vector<int> block(is_unknown_part.size(), -1);
  for (const int row : unknowns.rows) {
    const auto part = static_cast<std::size_t>(part_of_row[static_cast<std::size_t>(row)]);
    if (is_unknown_part[part] && block[part] < 0) block[part] = system.singular_block_count++;
    system.singular_block.push_back(block[part]);
  }
}

}  // namespace morphbake
