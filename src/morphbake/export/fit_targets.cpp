#include "morphbake/export/fit_targets.h"

#include <tbb/parallel_for.h>

#include <Eigen/QR>
#include <algorithm>

#include "morphbake/gltf/animated_mesh.h"

namespace morphbake {
namespace {

using VectorRows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// Sums over all moments.
struct Moments {
  Eigen::MatrixXd gram;  ///< #numbers by #numbers: the weights, and 1 where rest is fitted too
  VectorRows sums;       ///< #numbers by 3 #R
};

Moments moments_of(const MorphBasis& basis, const Positions& rest,
                   const std::vector<VectorMotion>& motions) {
  const auto targets = static_cast<Eigen::Index>(basis.targets.size());
  const Eigen::Index count = targets + (basis.kind == TargetKind::Basis ? 1 : 0);
  Moments moments{Eigen::MatrixXd::Zero(count, count), VectorRows::Zero(count, rest.size())};
  Eigen::VectorXd numbers = Eigen::VectorXd::Ones(count);
  for (std::size_t c = 0; c < motions.size(); ++c) {
    const WeightKeys& keys = basis.clips[c];
    for (const double time : motions[c].times) {
      numbers.head(targets) = interpolate_keys(keys.times, keys.weights, time);
      moments.gram += numbers * numbers.transpose();
      if (numbers.isZero(0)) continue;
      const Positions difference = motions[c].vectors_at(time) - rest;
      const Eigen::Map<const Eigen::RowVectorXd> row(difference.data(), difference.size());
      for (Eigen::Index k = 0; k < count; ++k) {
        if (numbers(k) != 0) moments.sums.row(k) += numbers(k) * row;
      }
    }
  }
  return moments;
}

/// rows <- matrix rows. Of frames that fade into one another the matrix is nearly empty.
void apply(const Eigen::MatrixXd& matrix, VectorRows& rows) {
  constexpr Eigen::Index kColumns = 1024;  // at once: they stay in caches
  const Eigen::Index parts = (rows.cols() + kColumns - 1) / kColumns;
  tbb::parallel_for(Eigen::Index{0}, parts, [&](Eigen::Index part) {
    const Eigen::Index first = part * kColumns;
    const Eigen::Index columns = std::min(kColumns, rows.cols() - first);
    const VectorRows old = rows.middleCols(first, columns);
    rows.middleCols(first, columns).setZero();
    for (Eigen::Index k = 0; k < matrix.rows(); ++k) {
      for (Eigen::Index m = 0; m < matrix.cols(); ++m) {
        if (matrix(k, m) != 0) rows.row(k).segment(first, columns) += matrix(k, m) * old.row(m);
      }
    }
  });
}

}  // namespace

FittedVectors fit_targets(const MorphBasis& basis, const Positions& rest,
                          const std::vector<VectorMotion>& motions) {
  FittedVectors fitted{rest, {}};
  if (basis.targets.empty()) return fitted;
  Moments moments = moments_of(basis, rest, motions);
  // Targets that never move, or move together, leave the Gram matrix singular: least norm then.
  apply(moments.gram.completeOrthogonalDecomposition().pseudoInverse(), moments.sums);
  const auto rows_of = [&](Eigen::Index number) {
    return Eigen::Map<const Positions>(moments.sums.row(number).data(), rest.rows(), 3);
  };
  for (std::size_t k = 0; k < basis.targets.size(); ++k) {
    fitted.targets.emplace_back(rows_of(static_cast<Eigen::Index>(k)));
  }
  if (basis.kind == TargetKind::Basis) fitted.rest += rows_of(moments.sums.rows() - 1);
  return fitted;
}

}  // namespace morphbake
