#include "morphbake/linear/shifted_factor.h"

#include <fmt/core.h>

#include <algorithm>

#include "morphbake/diagnostics/problem.h"
#include "morphbake/differential/laplacian.h"

namespace morphbake {
namespace {

/// A pivot below this share of its vertex's degree (of lambda times it, where that is less) makes
/// what is eliminated after it too large for its signs to be trusted: without pivoting, rounding
/// grows by its inverse.
constexpr double kSmallestPivot = 1e-8;

/// Steps away from such a pivot, as shares of lambda, each ten times as long.
constexpr double kFirstStep = 1e-7;
constexpr int kSteps = 4;

}  // namespace

Eigen::VectorXd spectral_degrees(const OneRings& rings) {
  const auto vertex_count = static_cast<Eigen::Index>(rings.offsets.size()) - 1;
  Eigen::VectorXd degrees(std::max<Eigen::Index>(0, vertex_count));
  for (int v = 0; v < degrees.size(); ++v) degrees(v) = std::max(1, rings.degree(v));
  return degrees;
}

ShiftedFactor::ShiftedFactor(const OneRings& rings)
    : laplacian_(symmetric_laplacian(rings)), degrees_(spectral_degrees(rings)) {
  if (degrees_.size() > 0) ldlt_.analyzePattern(laplacian_);
}

bool ShiftedFactor::is_sure(double lambda) {
  Eigen::SparseMatrix<double> shifted = laplacian_;
  for (Eigen::Index v = 0; v < degrees_.size(); ++v) {
    shifted.coeffRef(v, v) -= lambda * degrees_(v);
  }
  ldlt_.factorize(shifted);
  if (ldlt_.info() != Eigen::Success) return false;
  pivots_ = ldlt_.permutationPinv() * ldlt_.vectorD();
  const double smallest = kSmallestPivot * std::min(1.0, lambda);
  return (pivots_.array().abs() > smallest * degrees_.array()).all();
}

double ShiftedFactor::factorise(double lambda) {
  double taken = lambda;
  double step = kFirstStep;
  for (int i = 0; i <= kSteps; ++i, step *= 10) {
    if (is_sure(taken)) return taken;
    taken = lambda * (1 + step);
  }
  throw BakeError(Problem{Severity::Error,
                          "linear.no-eigenvectors",
                          {},
                          fmt::format("eigenvalues near {:.6g} cannot be told apart", lambda),
                          ""});
}

}  // namespace morphbake
