#include "morphbake/linear/spectrum_count.h"

#include <fmt/core.h>

#include <Eigen/SparseCholesky>
#include <algorithm>
#include <numeric>
#include <utility>

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

/// Above all eigenvalues. No simple number: eigenvalues of regular meshes are, and bisection must
/// not meet them.
constexpr double kAbove = 2.0123456789;

/// A guess comes no closer to an end of the interval than this share of it: it shrinks.
constexpr double kMargin = 0.05;

constexpr double kWeyl = 4;  ///< eigenvalues are about this many times their index / #V

}  // namespace

Eigen::VectorXd spectral_degrees(const OneRings& rings) {
  const auto vertex_count = static_cast<Eigen::Index>(rings.offsets.size()) - 1;
  Eigen::VectorXd degrees(std::max<Eigen::Index>(0, vertex_count));
  for (int v = 0; v < degrees.size(); ++v) degrees(v) = std::max(1, rings.degree(v));
  return degrees;
}

struct SpectrumCount::Factor {
  Eigen::SparseMatrix<double> laplacian;
  Eigen::VectorXd degrees;
  Components components;
  Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> ldlt;

  bool factorise(double lambda) {
    Eigen::SparseMatrix<double> shifted = laplacian;
    for (Eigen::Index v = 0; v < degrees.size(); ++v) shifted.coeffRef(v, v) -= lambda * degrees(v);
    ldlt.factorize(shifted);
    if (ldlt.info() != Eigen::Success) return false;
    const Eigen::VectorXd pivots = ldlt.permutationPinv() * ldlt.vectorD();
    const double smallest = kSmallestPivot * std::min(1.0, lambda);
    return (pivots.array().abs() > smallest * degrees.array()).all();
  }
};

SpectrumCount::SpectrumCount(const OneRings& rings) : factor_(std::make_unique<Factor>()) {
  factor_->laplacian = symmetric_laplacian(rings);
  factor_->degrees = spectral_degrees(rings);
  factor_->components = connected_components(rings);
  if (vertex_count() > 0) factor_->ldlt.analyzePattern(factor_->laplacian);
}

SpectrumCount::~SpectrumCount() = default;

int SpectrumCount::vertex_count() const { return static_cast<int>(factor_->degrees.size()); }

const Components& SpectrumCount::components() const { return factor_->components; }

int SpectrumCount::below(double lambda) {
  const std::vector<int> counts = below_by_component(lambda);
  return std::accumulate(counts.begin(), counts.end(), 0);
}

std::vector<int> SpectrumCount::below_by_component(double lambda) {
  const Components& components = factor_->components;
  std::vector<int> counts(static_cast<std::size_t>(components.count), 0);
  if (vertex_count() == 0 || !(lambda > 0)) return counts;
  if (lambda > 2) {
    for (const int label : components.label) ++counts[static_cast<std::size_t>(label)];
    return counts;
  }
  bool is_sure = factor_->factorise(lambda);
  double step = kFirstStep;
  for (int i = 0; i < kSteps && !is_sure; ++i, step *= 10) {
    is_sure = factor_->factorise(lambda * (1 + step));
  }
  if (!is_sure) {
    throw BakeError(Problem{Severity::Error,
                            "linear.no-eigenvectors",
                            {},
                            fmt::format("the eigenvalues below {:.6g} cannot be counted", lambda),
                            ""});
  }
  const Eigen::VectorXd pivots = factor_->ldlt.permutationPinv() * factor_->ldlt.vectorD();
  for (std::size_t v = 0; v < components.label.size(); ++v) {
    if (pivots(static_cast<Eigen::Index>(v)) < 0) {
      ++counts[static_cast<std::size_t>(components.label[v])];
    }
  }
  return counts;
}

Enclosure SpectrumCount::enclose(int fewest, int most, double precision, const Observer& observer) {
  double low = 0;
  Enclosure enclosure{kAbove, below_by_component(kAbove)};
  int total = vertex_count();
  const double middle = (fewest + 1.0 * most) / 2;
  double guess = kWeyl * middle / std::max(1, vertex_count());
  while (total > most && enclosure.lambda - low > precision * enclosure.lambda) {
    stop_if_cancelled(observer);
    const double margin = kMargin * (enclosure.lambda - low);
    guess = std::clamp(guess, low + margin, enclosure.lambda - margin);
    std::vector<int> found = below_by_component(guess);
    const int count = std::accumulate(found.begin(), found.end(), 0);
    if (count < fewest) {
      low = guess;
    } else {
      enclosure = {guess, std::move(found)};
      total = count;
    }
    guess *= middle / std::max(1, count);
  }
  return enclosure;
}

int eigenvalues_below(const OneRings& rings, double lambda) {
  return SpectrumCount(rings).below(lambda);
}

}  // namespace morphbake
