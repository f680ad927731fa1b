#include "morphbake/linear/spectrum_slices.h"

#include <Spectra/SymEigsSolver.h>
#include <fmt/core.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

#include "morphbake/diagnostics/problem.h"
#include "morphbake/linear/spectrum_count.h"

namespace morphbake {
namespace {

constexpr int kMostPairs = 32;    ///< a slice with more is cut in the middle,
constexpr double kNarrow = 1e-6;  ///< unless it is as narrow, relative: a multiple eigenvalue
constexpr double kEdge = 1e-9;    ///< an eigenvalue this close to an edge may lie on either side
constexpr int kRounds = 40;

[[noreturn]] void fail(const std::string& message, const std::string& hint) {
  throw BakeError(Problem{Severity::Error, "linear.no-eigenvectors", {}, message, hint});
}

/// Part of the spectrum, and how many eigenvalues but 0 it has, by the inertia at its edges.
struct Slice {
  double low = 0;
  double high = 0;
  int count = 0;

  double middle() const { return (low + high) / 2; }
};

/// Appends the slices of `whole`, from low to high.
void cut(SpectrumCount& spectrum, const Slice& whole, int below_low, const Observer& observer,
         std::vector<Slice>& slices) {
  if (whole.count == 0) return;
  if (whole.count > kMostPairs && whole.high - whole.low > kNarrow * whole.high) {
    stop_if_cancelled(observer);
    const Enclosure middle = spectrum.below(whole.middle());
    if (middle.lambda < whole.high) {
      const int count = middle.total() - below_low;
      cut(spectrum, {whole.low, middle.lambda, count}, below_low, observer, slices);
      cut(spectrum, {middle.lambda, whole.high, whole.count - count}, middle.total(), observer,
          slices);
      return;
    }
  }
  slices.push_back(whole);
}

/// What Spectra iterates on: (S - sigma)^-1, with `locked` vectors projected out.
class ShiftedInverse {
 public:
  using Scalar = double;  // NOLINT: Spectra's name for it

  ShiftedInverse(const OneRings& rings, double lambda, const Observer& observer)
      : root_(spectral_degrees(rings).cwiseSqrt()),
        factor_(rings),
        sigma_(factor_.factorise(lambda)),
        observer_(observer) {}

  double sigma() const { return sigma_; }

  Eigen::Index rows() const { return root_.size(); }

  Eigen::Index cols() const { return root_.size(); }

  void lock(const Eigen::MatrixXd& vectors) { locked_ = vectors; }

  void perform_op(const double* in, double* out) const {
    stop_if_cancelled(observer_);
    Eigen::VectorXd w = Eigen::Map<const Eigen::VectorXd>(in, rows());
    project(w);
    w = root_.cwiseProduct(factor_.solve(root_.cwiseProduct(w)));
    project(w);
    Eigen::Map<Eigen::VectorXd>(out, rows()) = w;
  }

 private:
  void project(Eigen::VectorXd& w) const { w -= locked_ * (locked_.transpose() * w); }

  Eigen::VectorXd root_;
  ShiftedFactor factor_;
  double sigma_;
  Eigen::MatrixXd locked_;
  const Observer& observer_;
};

/// One run of Spectra: the `count` pairs nearest to sigma that are not locked, or others.
Eigenpairs iterate(ShiftedInverse& inverse, Eigen::Index count, const EigenvectorOptions& options) {
  const Eigen::Index room = std::min(inverse.rows(), std::max(2 * count, count + 20));
  try {
    Spectra::SymEigsSolver<ShiftedInverse> solver(inverse, count, room);
    solver.init();
    solver.compute(Spectra::SortRule::LargestMagn, options.max_restarts, options.tolerance,
                   Spectra::SortRule::LargestMagn);
    if (solver.info() != Spectra::CompInfo::Successful) {
      fail(fmt::format("{} of {} eigenvectors converged within {} restarts",
                       solver.eigenvalues().size(), count, options.max_restarts),
           "ask for fewer");
    }
    return {inverse.sigma() + solver.eigenvalues().array().inverse(), solver.eigenvectors()};
  } catch (const std::runtime_error& error) {
    if (dynamic_cast<const BakeError*>(&error) != nullptr) throw;
    fail(fmt::format("Spectra: {}", error.what()), "");
  }
}

Eigenpairs joined(const Eigenpairs& a, const Eigenpairs& b) {
  const Eigen::Index count = a.values.size() + b.values.size();
  Eigenpairs all{Eigen::VectorXd(count), Eigen::MatrixXd(a.vectors.rows(), count)};
  all.values << a.values, b.values;
  all.vectors << a.vectors, b.vectors;
  return all;
}

/// Of the pairs but the constant, which is the first, those in the slice: the nearest to its
/// middle, and no more than it has.
std::vector<Eigen::Index> inside(const Slice& slice, const Eigen::VectorXd& values) {
  const double margin = kEdge * slice.high;
  std::vector<Eigen::Index> order;
  for (Eigen::Index k = 1; k < values.size(); ++k) {
    if (values(k) > slice.low - margin && values(k) < slice.high + margin) order.push_back(k);
  }
  std::stable_sort(order.begin(), order.end(), [&](Eigen::Index a, Eigen::Index b) {
    return std::abs(values(a) - slice.middle()) < std::abs(values(b) - slice.middle());
  });
  order.resize(std::min(order.size(), static_cast<std::size_t>(slice.count)));
  return order;
}

/// An eigenvalue that occurs twice shows one of its vectors to an iteration that starts from one
/// vector, and rounding the other, sooner or later. So what is found is projected out and the
/// iteration repeated until as many are there as the inertia has counted.
Eigenpairs solve_slice(const OneRings& rings, const Slice& slice, const EigenvectorOptions& options,
                       const Observer& observer) {
  ShiftedInverse inverse(rings, slice.middle(), observer);
  Eigenpairs found{Eigen::VectorXd::Zero(1), constant_eigenvector(rings)};
  std::vector<Eigen::Index> kept;
  for (int round = 0; round < kRounds; ++round) {
    const Eigen::Index missing = slice.count - static_cast<Eigen::Index>(kept.size());
    inverse.lock(found.vectors);
    found = joined(found, iterate(inverse, missing, options));
    kept = inside(slice, found.values);
    if (static_cast<int>(kept.size()) == slice.count) {
      return {found.values(kept), found.vectors(Eigen::all, kept)};
    }
  }
  fail(fmt::format("{} of {} eigenvectors between {:.6g} and {:.6g} were found", kept.size(),
                   slice.count, slice.low, slice.high),
       "");
}

/// Two close eigenvalues on either side of an edge: their vectors were found one by one.
void make_orthogonal(const Eigen::MatrixXd& before, Eigen::MatrixXd& vectors) {
  vectors -= before * (before.transpose() * vectors);
  if (vectors.colwise().squaredNorm().minCoeff() < 0.5) {
    fail("an eigenvector was found twice", "ask for one more or fewer");
  }
  vectors.colwise().normalize();
}

}  // namespace

Eigen::VectorXd constant_eigenvector(const OneRings& rings) {
  return spectral_degrees(rings).cwiseSqrt().normalized();
}

Eigenpairs eigenpairs_below(const OneRings& rings, double lambda, int count,
                            const EigenvectorOptions& options, const Observer& observer) {
  std::vector<Slice> slices;
  SpectrumCount spectrum(rings);
  cut(spectrum, {0, lambda, count - 1}, 1, observer, slices);
  std::vector<Eigenpairs> solved(slices.size());
  tbb::parallel_for(std::size_t{0}, slices.size(), [&](std::size_t s) {
    solved[s] = solve_slice(rings, slices[s], options, observer);
  });
  Eigenpairs pairs{Eigen::VectorXd::Zero(1), constant_eigenvector(rings)};
  for (std::size_t s = 0; s < slices.size(); ++s) {
    if (s > 0) make_orthogonal(solved[s - 1].vectors, solved[s].vectors);
    pairs = joined(pairs, solved[s]);
  }
  return pairs;
}

}  // namespace morphbake
