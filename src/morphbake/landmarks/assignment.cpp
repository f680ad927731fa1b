#include "morphbake/landmarks/assignment.h"

#include <limits>

namespace morphbake {
namespace {

/// Columns of a square cost matrix's rows, by shortest augmenting paths with potentials.
std::vector<int> square_assignment(const Eigen::MatrixXd& cost) {
  const auto n = static_cast<int>(cost.rows());
  const auto size = static_cast<std::size_t>(n) + 1;
  std::vector<double> row_potential(size, 0), column_potential(size, 0);
  std::vector<int> row_of(size, 0);  // by column; 0 is none, so rows and columns count from 1
  for (int row = 1; row <= n; ++row) {
    std::vector<double> slack(size, std::numeric_limits<double>::infinity());
    std::vector<int> before(size, 0);
    std::vector<char> is_used(size, 0);
    int column = 0;
    row_of[0] = row;
    do {
      is_used[column] = 1;
      const int from = row_of[column];
      double least = std::numeric_limits<double>::infinity();
      int next = 0;
      for (int j = 1; j <= n; ++j) {
        if (is_used[j]) continue;
        const double reduced = cost(from - 1, j - 1) - row_potential[from] - column_potential[j];
        if (reduced < slack[j]) {
          slack[j] = reduced;
          before[j] = column;
        }
        if (slack[j] < least) {
          least = slack[j];
          next = j;
        }
      }
      for (int j = 0; j <= n; ++j) {
        if (is_used[j]) {
          row_potential[row_of[j]] += least;
          column_potential[j] -= least;
        } else {
          slack[j] -= least;
        }
      }
      column = next;
    } while (row_of[column] != 0);
    while (column != 0) {
      row_of[column] = row_of[before[column]];
      column = before[column];
    }
  }
  std::vector<int> column_of(static_cast<std::size_t>(n));
  for (int j = 1; j <= n; ++j) column_of[row_of[j] - 1] = j - 1;
  return column_of;
}

}  // namespace

std::vector<int> assign(const Eigen::MatrixXd& cost, double alone) {
  const Eigen::Index rows = cost.rows(), columns = cost.cols();
  // A partner of its own for each that may stay alone; those partners go with each other for free.
  Eigen::MatrixXd padded = Eigen::MatrixXd::Zero(rows + columns, rows + columns);
  padded.topLeftCorner(rows, columns) = cost;
  padded.topRightCorner(rows, rows).setConstant(alone);
  padded.bottomLeftCorner(columns, columns).setConstant(alone);
  std::vector<int> partners = square_assignment(padded);
  partners.resize(static_cast<std::size_t>(rows));
  for (int& partner : partners) {
    if (partner >= columns) partner = -1;
  }
  return partners;
}

}  // namespace morphbake
