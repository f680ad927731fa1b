#include "morphbake/export/fit_targets.h"

#include <tbb/parallel_for.h>

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <utility>

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

/// The fit that the moments lead to.
FittedVectors solved(const MorphBasis& basis, const Positions& rest, Moments moments) {
  FittedVectors fitted{rest, {}};
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

/// The factor that makes a fitted rest a unit vector; 0 where it has no direction.
double unit_scale(const Eigen::RowVector3d& fitted) {
  constexpr double kShortest = 1e-6;
  const double length = fitted.norm();
  return length > kShortest ? 1 / length : 0;
}

/// min |A x - b|^2 within [-1, 1] by its normal equations, from a start: coordinate after
/// coordinate.
///
/// @param gram  A^T A
/// @param sums  A^T b
void bound_to_unit(const Eigen::MatrixXd& gram, const Eigen::VectorXd& sums, Eigen::VectorXd& x) {
  constexpr int kMostSweeps = 200;
  constexpr double kSettled = 1e-6;
  x = x.cwiseMax(-1).cwiseMin(1);
  for (int sweep = 0; sweep < kMostSweeps; ++sweep) {
    double moved = 0;
    for (Eigen::Index k = 0; k < x.size(); ++k) {
      if (!(gram(k, k) > 0)) continue;
      const double step = (sums(k) - gram.row(k).dot(x)) / gram(k, k);
      const double next = std::clamp(x(k) + step, -1.0, 1.0);
      moved = std::max(moved, std::abs(next - x(k)));
      x(k) = next;
    }
    if (moved <= kSettled) return;
  }
}

/// Brings what is fitted of rest into [0, 1], and fits the targets of such numbers anew.
///
/// @param first    rest before it was fitted
/// @param moments  against `first`
void bound_rest(const Positions& first, const Moments& moments, FittedVectors& fitted) {
  const auto count = static_cast<Eigen::Index>(fitted.targets.size());
  const Eigen::MatrixXd inverse =
      moments.gram.topLeftCorner(count, count).completeOrthogonalDecomposition().pseudoInverse();
  const auto weights = moments.gram.col(count).head(count);  // their sums
  for (Eigen::Index r = 0; r < first.rows(); ++r) {
    for (Eigen::Index axis = 0; axis < 3; ++axis) {
      double& rest = fitted.rest(r, axis);
      if (rest >= 0 && rest <= 1) continue;
      rest = std::clamp(rest, 0.0, 1.0);
      const Eigen::VectorXd sums = moments.sums.col(3 * r + axis).head(count);
      const Eigen::VectorXd x = inverse * (sums + (first(r, axis) - rest) * weights);
      for (Eigen::Index k = 0; k < count; ++k) {
        fitted.targets[static_cast<std::size_t>(k)](r, axis) = x(k);
      }
    }
  }
}

/// Whether few enough vectors have targets beyond [-1, 1] that bounding those costs little.
bool exceed_rarely(const std::vector<Positions>& targets) {
  constexpr double kFew = 0.01;
  const Eigen::Index count = targets.front().rows();
  Eigen::Index exceeding = 0;
  for (Eigen::Index r = 0; r < count; ++r) {
    exceeding += std::any_of(targets.begin(), targets.end(), [r](const Positions& target) {
      return target.row(r).cwiseAbs().maxCoeff() > 1;
    });
  }
  return static_cast<double>(exceeding) <= kFew * static_cast<double>(count);
}

/// Fits anew what leaves [-1, 1], under the scales that are found already.
///
/// @param first    rest before it was fitted
/// @param scales   of the fitted ones
/// @param moments  against `first`
void bound_targets(const Normals& first, const Eigen::VectorXd& scales, const Moments& moments,
                   FittedVectors& fitted) {
  const auto count = static_cast<Eigen::Index>(fitted.targets.size());
  const Eigen::MatrixXd gram = moments.gram.topLeftCorner(count, count);
  const bool is_rest_fitted = moments.gram.rows() > count;
  for (Eigen::Index r = 0; r < first.rows(); ++r) {
    for (Eigen::Index axis = 0; axis < 3; ++axis) {
      Eigen::VectorXd x(count), sums(count);
      for (Eigen::Index k = 0; k < count; ++k) {
        x(k) = fitted.targets[static_cast<std::size_t>(k)](r, axis);
      }
      if (x.cwiseAbs().maxCoeff() <= 1) continue;
      sums = moments.sums.col(3 * r + axis).head(count);
      if (is_rest_fitted) {
        const auto weights = moments.gram.col(count).head(count);  // their sums
        sums = scales(r) * (sums + first(r, axis) * weights) - fitted.rest(r, axis) * weights;
      }
      bound_to_unit(gram, sums, x);
      for (Eigen::Index k = 0; k < count; ++k) {
        fitted.targets[static_cast<std::size_t>(k)](r, axis) = x(k);
      }
    }
  }
}

}  // namespace

FittedVectors fit_colours(const MorphBasis& basis, const Positions& rest,
                          const std::vector<VectorMotion>& motions) {
  if (basis.targets.empty()) return {rest, {}};
  const Moments moments = moments_of(basis, rest, motions);
  FittedVectors fitted = solved(basis, rest, moments);
  if (basis.kind == TargetKind::Basis) bound_rest(rest, moments, fitted);
  return fitted;
}

FittedVectors fit_directions(const MorphBasis& basis, const Normals& rest,
                             const std::vector<VectorMotion>& motions, TargetRange range) {
  if (basis.targets.empty()) return {rest, {}};
  const Moments moments = moments_of(basis, rest, motions);
  FittedVectors fitted = solved(basis, rest, moments);
  Eigen::VectorXd scales = Eigen::VectorXd::Ones(rest.rows());
  if (basis.kind == TargetKind::Basis) {
    for (Eigen::Index r = 0; r < rest.rows(); ++r) {
      scales(r) = unit_scale(fitted.rest.row(r));
      if (scales(r) == 0) {  // the fit says nothing
        scales(r) = 1;
        fitted.rest.row(r) = rest.row(r);
        continue;
      }
      fitted.rest.row(r) *= scales(r);
      for (Positions& target : fitted.targets) target.row(r) *= scales(r);
    }
  }
  if (range == TargetRange::Unit && exceed_rarely(fitted.targets)) {
    bound_targets(rest, scales, moments, fitted);
  }
  return fitted;
}

}  // namespace morphbake
