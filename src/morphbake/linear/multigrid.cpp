#include "morphbake/linear/multigrid.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace morphbake {
namespace {

using Sparse = Eigen::SparseMatrix<double>;

constexpr Eigen::Index kCoarsest = 100;  // rows that are factorised
constexpr double kCoarser = 0.8;         // levels that keep more rows than this are not worth it

/// Of the geometric mean of both diagonals; coarser levels have more and weaker entries.
double strong_at(std::size_t level) { return 0.08 * std::pow(0.5, static_cast<double>(level)); }

/// Aggregates of rows: each row's number. Whole neighbourhoods first, then what is beside one, then
/// what is left.
struct Aggregates {
  std::vector<int> of_row;
  int count = 0;
};

Aggregates aggregate(const Sparse& A, double strong) {
  const Eigen::VectorXd diagonal = A.diagonal();
  Aggregates made;
  made.of_row.assign(static_cast<std::size_t>(A.rows()), -1);
  const auto number = [&](Eigen::Index row) -> int& {
    return made.of_row[static_cast<std::size_t>(row)];
  };
  const auto for_strong = [&](Eigen::Index row, const auto& each) {
    for (Sparse::InnerIterator entry(A, row); entry; ++entry) {
      if (entry.row() == row) continue;
      const double least = strong * std::sqrt(diagonal(row) * diagonal(entry.row()));
      if (std::abs(entry.value()) >= least) each(entry.row(), std::abs(entry.value()));
    }
  };
  for (Eigen::Index row = 0; row < A.rows(); ++row) {
    bool is_free = number(row) < 0;
    for_strong(row, [&](Eigen::Index other, double) { is_free = is_free && number(other) < 0; });
    if (!is_free) continue;
    number(row) = made.count;
    for_strong(row, [&](Eigen::Index other, double) { number(other) = made.count; });
    ++made.count;
  }
  std::vector<int> beside = made.of_row;
  for (Eigen::Index row = 0; row < A.rows(); ++row) {
    if (number(row) >= 0) continue;
    double strongest = 0;
    for_strong(row, [&](Eigen::Index other, double value) {
      if (number(other) < 0 || value <= strongest) return;
      strongest = value;
      beside[static_cast<std::size_t>(row)] = number(other);
    });
  }
  made.of_row = std::move(beside);
  for (Eigen::Index row = 0; row < A.rows(); ++row) {
    if (number(row) >= 0) continue;
    number(row) = made.count;
    for_strong(row, [&](Eigen::Index other, double) {
      if (number(other) < 0) number(other) = made.count;
    });
    ++made.count;
  }
  return made;
}

/// (I - 4/3 / bound D^-1 A) P_0, P_0 constant over each aggregate.
Sparse smoothed_prolongation(const Sparse& A, const Aggregates& aggregates) {
  std::vector<Eigen::Triplet<double>> entries;
  for (Eigen::Index row = 0; row < A.rows(); ++row) {
    entries.emplace_back(static_cast<int>(row), aggregates.of_row[static_cast<std::size_t>(row)],
                         1.0);
  }
  Sparse tentative(A.rows(), aggregates.count);
  tentative.setFromTriplets(entries.begin(), entries.end());
  const Eigen::VectorXd diagonal = A.diagonal();
  Eigen::VectorXd inverse(A.rows());
  double bound = 0;  // Gershgorin's, of the eigenvalues of D^-1 A
  for (Eigen::Index row = 0; row < A.rows(); ++row) {
    inverse(row) = diagonal(row) > 0 ? 1 / diagonal(row) : 0;
    double sum = 0;
    for (Sparse::InnerIterator entry(A, row); entry; ++entry) sum += std::abs(entry.value());
    bound = std::max(bound, sum * inverse(row));
  }
  if (!(bound > 0)) return tentative;
  const Sparse spread = A * tentative;
  return tentative - Sparse(((4.0 / 3 / bound) * inverse).asDiagonal() * spread);
}

/// Of the rows that an aggregate is made of, which lie in one block.
SymmetricSystem coarse_system(const SymmetricSystem& fine, const Aggregates& aggregates,
                              const Sparse& prolongation) {
  SymmetricSystem coarse;
  coarse.matrix = prolongation.transpose() * Sparse(fine.matrix * prolongation);
  coarse.singular_block.assign(static_cast<std::size_t>(aggregates.count), -1);
  for (std::size_t row = 0; row < aggregates.of_row.size(); ++row) {
    coarse.singular_block[static_cast<std::size_t>(aggregates.of_row[row])] =
        fine.singular_block[row];
  }
  coarse.singular_block_count = fine.singular_block_count;
  return coarse;
}

std::size_t bytes_of(const Sparse& matrix) {
  return static_cast<std::size_t>(matrix.nonZeros()) * (sizeof(double) + sizeof(int)) +
         static_cast<std::size_t>(matrix.outerSize()) * sizeof(int);
}

}  // namespace

Multigrid::Multigrid(const SymmetricSystem& system)
    : finest_(system), levels_(coarser_levels(system)), coarsest_(system_of(levels_.size())) {}

std::vector<std::unique_ptr<const Multigrid::Level>> Multigrid::coarser_levels(
    const SymmetricSystem& finest) {
  std::vector<std::unique_ptr<const Level>> levels;
  const SymmetricSystem* fine = &finest;
  while (fine->matrix.rows() > kCoarsest) {
    const Aggregates aggregates = aggregate(fine->matrix, strong_at(levels.size()));
    if (aggregates.count > kCoarser * static_cast<double>(fine->matrix.rows())) break;
    auto level = std::make_unique<Level>();
    level->prolongation = smoothed_prolongation(fine->matrix, aggregates);
    level->coarse = coarse_system(*fine, aggregates, level->prolongation);
    levels.push_back(std::move(level));
    fine = &levels.back()->coarse;
  }
  return levels;
}

const SymmetricSystem& Multigrid::system_of(std::size_t level) const {
  return level == 0 ? finest_ : levels_[level - 1]->coarse;
}

ThreeColumns Multigrid::cycle(std::size_t level, const ThreeColumns& r) const {
  const Sparse& A = system_of(level).matrix;
  if (level == levels_.size()) return coarsest_.solve(r);
  const Sparse& P = levels_[level]->prolongation;
  ThreeColumns x = ThreeColumns::Zero(r.rows(), 3);
  for (Eigen::Index row = 0; row < r.rows(); ++row) x.row(row) = relaxed_row(A, r, x, row);
  const ThreeColumns left = r - A * x;
  x += P * cycle(level + 1, P.transpose() * left);
  for (Eigen::Index row = r.rows(); row-- > 0;) x.row(row) = relaxed_row(A, r, x, row);
  return x;
}

std::size_t Multigrid::bytes() const {
  std::size_t sum = coarsest_.bytes();
  for (const auto& level : levels_) {
    sum += bytes_of(level->prolongation) + bytes_of(level->coarse.matrix);
  }
  return sum;
}

}  // namespace morphbake
