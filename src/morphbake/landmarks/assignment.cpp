#include "morphbake/landmarks/assignment.h"

#include <limits>

namespace morphbake {
namespace {

/// Rows and columns count from 1; 0 is none.
struct Matching {
  explicit Matching(std::size_t size)
      : row_potential(size, 0), column_potential(size, 0), row_of(size, 0) {}

  std::vector<double> row_potential, column_potential;
  std::vector<int> row_of;  ///< by column
};

/// The shortest paths from a row to the columns, as far as they are known.
struct Paths {
  explicit Paths(std::size_t size)
      : slack(size, std::numeric_limits<double>::infinity()), before(size, 0), is_used(size, 0) {}

  std::vector<double> slack;
  std::vector<int> before;  ///< by column
  std::vector<char> is_used;
};

/// Leads the paths on from a column that they have reached; returns the column that is next.
int lead_on(const Eigen::MatrixXd& cost, const Matching& matching, int column, Paths& paths) {
  const int from = matching.row_of[column];
  double least = std::numeric_limits<double>::infinity();
  int next = 0;
  for (int j = 1; j <= static_cast<int>(cost.cols()); ++j) {
    if (paths.is_used[j]) continue;
    const double reduced =
        cost(from - 1, j - 1) - matching.row_potential[from] - matching.column_potential[j];
    if (reduced < paths.slack[j]) {
      paths.slack[j] = reduced;
      paths.before[j] = column;
    }
    if (paths.slack[j] < least) {
      least = paths.slack[j];
      next = j;
    }
  }
  return next;
}

/// Shifts the potentials so that a column of that slack can be matched.
void shift_potentials(double least, Matching& matching, Paths& paths) {
  for (std::size_t j = 0; j < paths.slack.size(); ++j) {
    if (paths.is_used[j]) {
      matching.row_potential[matching.row_of[j]] += least;
      matching.column_potential[j] -= least;
    } else {
      paths.slack[j] -= least;
    }
  }
}

/// Columns of a square cost matrix's rows, by shortest augmenting paths with potentials.
std::vector<int> square_assignment(const Eigen::MatrixXd& cost) {
  const auto n = static_cast<int>(cost.rows());
  const auto size = static_cast<std::size_t>(n) + 1;
  Matching matching(size);
  std::vector<int>& row_of = matching.row_of;
  for (int row = 1; row <= n; ++row) {
    Paths paths(size);
    int column = 0;
    row_of[0] = row;
    do {
      paths.is_used[column] = 1;
      const int next = lead_on(cost, matching, column, paths);
      shift_potentials(paths.slack[next], matching, paths);
      column = next;
    } while (row_of[column] != 0);
    while (column != 0) {
      row_of[column] = row_of[paths.before[column]];
      column = paths.before[column];
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
