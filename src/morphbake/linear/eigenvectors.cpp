#include "morphbake/linear/eigenvectors.h"

#include <Spectra/SymEigsSolver.h>
#include <fmt/core.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "morphbake/diagnostics/problem.h"
#include "morphbake/differential/laplacian.h"
#include "morphbake/linear/cholesky_factor.h"
#include "morphbake/linear/spectrum_count.h"

// Lanczos on S^-1 itself spends most of its time keeping its vectors orthogonal, so a Chebyshev
// polynomial of the inverse is iterated instead: it costs three solves a step, pulls the wanted
// eigenvalues apart from the others, and a room of 1.5 times the wanted vectors is enough.
// pipeline/bench compares the two.

namespace morphbake {
namespace {

constexpr std::size_t kDenseVertices = 400;  ///< components up to this size, and
constexpr std::size_t kDenseShare = 4;       ///< those of which one in so many pairs are wanted

constexpr int kPolynomialDegree = 3;
constexpr double kShift = 0.1;     ///< epsilon of K_L + epsilon Deg, as a share of mu
constexpr double kUnwanted = 1.4;  ///< the polynomial is small above this many times mu
constexpr int kExtraShare = 10;    ///< mu may enclose one in so many more than were asked for
constexpr int kRounds = 40;

constexpr double kSame = 1e-9;  ///< eigenvalues this close, relative, are one
constexpr double kLargestResidual = 1e-8;

[[noreturn]] void fail(const std::string& message, const std::string& hint) {
  throw BakeError(Problem{Severity::Error, "linear.no-eigenvectors", {}, message, hint});
}

/// Eigenvectors of S, not of K_L: orthonormal.
struct Pairs {
  Eigen::VectorXd values;
  Eigen::MatrixXd vectors;
};

/// One component as a mesh of its own.
struct Piece {
  std::vector<int> vertices;  ///< in the whole mesh, rising
  Eigen::SparseMatrix<double> laplacian;
  Eigen::VectorXd root;  ///< Deg^1/2
  int wanted = 0;        ///< eigenvalues below mu

  Eigen::MatrixXd apply(const Eigen::MatrixXd& w) const {
    const auto inverse_root = root.cwiseInverse().asDiagonal();
    return inverse_root * (laplacian * (inverse_root * w));
  }
};

std::vector<Piece> split(const OneRings& rings, const Components& components) {
  std::vector<Piece> pieces(static_cast<std::size_t>(components.count));
  std::vector<int> local;
  for (std::size_t v = 0; v < components.label.size(); ++v) {
    Piece& piece = pieces[static_cast<std::size_t>(components.label[v])];
    local.push_back(static_cast<int>(piece.vertices.size()));
    piece.vertices.push_back(static_cast<int>(v));
  }
  const Eigen::VectorXd degrees = spectral_degrees(rings);
  for (Piece& piece : pieces) {
    OneRings own;
    own.offsets.push_back(0);
    for (const int v : piece.vertices) {
      const auto vertex = static_cast<std::size_t>(v);
      for (int n = rings.offsets[vertex]; n < rings.offsets[vertex + 1]; ++n) {
        const int neighbour = rings.neighbours[static_cast<std::size_t>(n)];
        own.neighbours.push_back(local[static_cast<std::size_t>(neighbour)]);
      }
      own.offsets.push_back(static_cast<int>(own.neighbours.size()));
    }
    piece.laplacian = symmetric_laplacian(own);
    piece.root = degrees(piece.vertices).cwiseSqrt();
  }
  return pieces;
}

/// Whether a dense solver is no slower, or the iteration would have too little room.
bool is_dense(std::size_t vertex_count, int wanted) {
  return vertex_count <= kDenseVertices ||
         static_cast<std::size_t>(wanted) > vertex_count / kDenseShare;
}

/// mu with `count` eigenvalues below it, or a few more.
Enclosure enclose(SpectrumCount& spectrum, int count, const Observer& observer) {
  const int vertex_count = spectrum.vertex_count();
  const bool takes_all = is_dense(static_cast<std::size_t>(vertex_count), count);
  const int most = takes_all ? vertex_count : count + count / kExtraShare + 4;
  return spectrum.enclose(count, most, kSame, observer);
}

Eigen::VectorXd constant_of(const Piece& piece) { return piece.root.normalized(); }

Pairs solve_dense(const Piece& piece) {
  const auto vertex_count = static_cast<Eigen::Index>(piece.vertices.size());
  const Eigen::MatrixXd S = piece.apply(Eigen::MatrixXd::Identity(vertex_count, vertex_count));
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(S);
  if (solver.info() != Eigen::Success) fail("the dense eigenvalue solver failed", "");
  return {solver.eigenvalues().head(piece.wanted), solver.eigenvectors().leftCols(piece.wanted)};
}

/// What Spectra iterates on: p((S + epsilon)^-1), with `locked` vectors projected out.
class FilteredInverse {
 public:
  using Scalar = double;  // NOLINT: Spectra's name for it

  FilteredInverse(const Piece& piece, double mu, const Observer& observer)
      : root_(piece.root),
        factor_(shifted(piece, kShift * mu)),
        scale_(2 * (kUnwanted + kShift) * mu),
        observer_(observer) {}

  Eigen::Index rows() const { return root_.size(); }

  Eigen::Index cols() const { return root_.size(); }

  void lock(const Eigen::MatrixXd& vectors) { locked_ = vectors; }

  void perform_op(const double* in, double* out) const {
    stop_if_cancelled(observer_);
    Eigen::VectorXd previous = Eigen::Map<const Eigen::VectorXd>(in, rows());
    project(previous);
    Eigen::VectorXd current = mapped(previous);
    for (int k = 1; k < kPolynomialDegree; ++k) {
      previous = 2 * mapped(current) - previous;
      previous.swap(current);
    }
    project(current);
    Eigen::Map<Eigen::VectorXd>(out, rows()) = current;
  }

 private:
  static SymmetricSystem shifted(const Piece& piece, double epsilon) {
    SymmetricSystem system{piece.laplacian, std::vector<int>(piece.vertices.size(), -1), 0};
    for (Eigen::Index v = 0; v < piece.root.size(); ++v) {
      system.matrix.coeffRef(v, v) += epsilon * piece.root(v) * piece.root(v);
    }
    return system;
  }

  /// The inverse of S + epsilon, with what is unwanted of its eigenvalues mapped to [-1, 1].
  Eigen::VectorXd mapped(const Eigen::VectorXd& w) const {
    return scale_ * root_.cwiseProduct(factor_.solve(root_.cwiseProduct(w)).col(0)) - w;
  }

  void project(Eigen::VectorXd& w) const { w -= locked_ * (locked_.transpose() * w); }

  const Eigen::VectorXd& root_;
  CholeskyFactor factor_;
  double scale_;
  Eigen::MatrixXd locked_;
  const Observer& observer_;
};

/// One run of Spectra: up to `count` further eigenvectors, of any quality.
Eigen::MatrixXd iterate(FilteredInverse& inverse, Eigen::Index count,
                        const EigenvectorOptions& options) {
  const Eigen::Index room = std::min(inverse.rows(), std::max(count + count / 2, count + 30));
  try {
    Spectra::SymEigsSolver<FilteredInverse> solver(inverse, count, room);
    solver.init();
    solver.compute(Spectra::SortRule::LargestAlge, options.max_restarts, options.tolerance,
                   Spectra::SortRule::LargestAlge);
    if (solver.info() != Spectra::CompInfo::Successful) {
      fail(fmt::format("{} of {} eigenvectors converged within {} restarts",
                       solver.eigenvalues().size(), count, options.max_restarts),
           "ask for fewer");
    }
    return solver.eigenvectors();
  } catch (const std::runtime_error& error) {
    if (dynamic_cast<const BakeError*>(&error) != nullptr) throw;
    fail(fmt::format("Spectra: {}", error.what()), "");
  }
}

/// The eigenvectors below mu of a component.
///
/// An eigenvalue that occurs twice shows one of its vectors to an iteration that starts from one
/// vector, and rounding the other, sooner or later. So what is found is projected out and the
/// iteration repeated until as many are there as were counted.
Pairs solve_sparse(const Piece& piece, double mu, const EigenvectorOptions& options,
                   const Observer& observer) {
  FilteredInverse inverse(piece, mu, observer);
  const double limit = mu * (1 + kSame);
  Pairs found{Eigen::VectorXd::Zero(1), constant_of(piece)};
  for (int round = 0; found.values.size() < piece.wanted && round < kRounds; ++round) {
    inverse.lock(found.vectors);
    const Eigen::MatrixXd candidates =
        iterate(inverse, piece.wanted - found.values.size(), options);
    const Eigen::VectorXd values =
        candidates.cwiseProduct(piece.apply(candidates)).colwise().sum().transpose();
    std::vector<Eigen::Index> kept;
    for (Eigen::Index k = 0; k < values.size(); ++k) {
      if (values(k) < limit) kept.push_back(k);
    }
    Pairs grown{Eigen::VectorXd(found.values.size() + static_cast<Eigen::Index>(kept.size())), {}};
    grown.values << found.values, values(kept);
    grown.vectors.resize(piece.root.size(), grown.values.size());
    grown.vectors << found.vectors, candidates(Eigen::all, kept);
    found = std::move(grown);
  }
  if (found.values.size() < piece.wanted) {
    fail(fmt::format("{} of {} eigenvectors were found", found.values.size(), piece.wanted), "");
  }
  return found;
}

Pairs solve_piece(const Piece& piece, double mu, const EigenvectorOptions& options,
                  const Observer& observer) {
  Pairs pairs;
  if (piece.wanted <= 1) {
    pairs = {Eigen::VectorXd::Zero(piece.wanted), constant_of(piece).leftCols(piece.wanted)};
  } else if (is_dense(piece.vertices.size(), piece.wanted)) {
    pairs = solve_dense(piece);
  } else {
    pairs = solve_sparse(piece, mu, options, observer);
  }
  if (piece.wanted > 0) {
    pairs.values(0) = 0;
    pairs.vectors.col(0) = constant_of(piece);
  }
  return pairs;
}

/// Of the entries that are nearly the largest, the first becomes positive.
void choose_sign(Eigen::Ref<Eigen::VectorXd> vector) {
  const double large = 0.5 * vector.cwiseAbs().maxCoeff();
  for (const double entry : vector) {
    if (std::abs(entry) < large) continue;
    if (entry < 0) vector = -vector;
    return;
  }
}

struct Place {
  double value = 0;
  std::size_t piece = 0;
  Eigen::Index column = 0;
};

/// The smallest pairs of all components; equal ones in the order of the components.
std::vector<Place> smallest_places(const std::vector<Pairs>& pairs, int count) {
  std::vector<Place> places;
  for (std::size_t p = 0; p < pairs.size(); ++p) {
    for (Eigen::Index k = 0; k < pairs[p].values.size(); ++k) {
      places.push_back({pairs[p].values(k), p, k});
    }
  }
  std::stable_sort(places.begin(), places.end(),
                   [](const Place& a, const Place& b) { return a.value < b.value; });
  places.resize(std::min(places.size(), static_cast<std::size_t>(count)));
  return places;
}

SpectralBasis assemble(const std::vector<Piece>& pieces, const std::vector<Pairs>& pairs,
                       Eigen::Index vertex_count, int count) {
  const std::vector<Place> places = smallest_places(pairs, count);
  const auto pair_count = static_cast<Eigen::Index>(places.size());
  SpectralBasis basis{Eigen::VectorXd(pair_count), Eigen::MatrixXd::Zero(vertex_count, pair_count),
                      Eigen::VectorXd(pair_count)};
  for (Eigen::Index k = 0; k < pair_count; ++k) {
    const Place& place = places[static_cast<std::size_t>(k)];
    const Piece& piece = pieces[place.piece];
    const Eigen::VectorXd w = pairs[place.piece].vectors.col(place.column);
    basis.eigenvalues(k) = place.value;
    basis.residuals(k) = (piece.apply(w) - place.value * w).norm();
    basis.vectors.col(k)(piece.vertices) = w.cwiseQuotient(piece.root);
    choose_sign(basis.vectors.col(k));
  }
  return basis;
}

}  // namespace

SpectralBasis smallest_eigenvectors(const OneRings& rings, int count,
                                    const EigenvectorOptions& options, const Observer& observer) {
  SpectrumCount spectrum(rings);
  if (count < 1 || count > spectrum.vertex_count()) {
    fail(fmt::format("{} eigenvectors of a mesh of {} vertices", count, spectrum.vertex_count()),
         "");
  }
  std::vector<Piece> pieces = split(rings, spectrum.components());
  Enclosure below{0, std::vector<int>(pieces.size(), 1)};  // the constants
  if (count > spectrum.components().count) below = enclose(spectrum, count, observer);
  std::vector<Pairs> pairs;
  for (std::size_t p = 0; p < pieces.size(); ++p) {
    pieces[p].wanted = below.counts[p];
    pairs.push_back(solve_piece(pieces[p], below.lambda, options, observer));
  }
  SpectralBasis basis = assemble(pieces, pairs, spectrum.vertex_count(), count);
  const double residual = basis.residuals.maxCoeff();
  if (!(residual <= kLargestResidual)) {
    fail(fmt::format("an eigenvector has a residual of {:.1e}", residual), "ask for fewer");
  }
  return basis;
}

}  // namespace morphbake
