#include "morphbake/linear/eigenvectors.h"

#include <fmt/core.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "morphbake/diagnostics/problem.h"
#include "morphbake/differential/laplacian.h"
#include "morphbake/linear/spectrum_count.h"
#include "morphbake/linear/spectrum_slices.h"

namespace morphbake {
namespace {

constexpr std::size_t kDenseVertices = 400;  ///< components up to this size, and
constexpr std::size_t kDenseShare = 4;       ///< those of which one in so many pairs are wanted

constexpr int kExtraShare = 10;  ///< lambda may enclose one in so many more than were asked for

constexpr double kSame = 1e-9;  ///< eigenvalues this close, relative, are one
constexpr double kLargestResidual = 1e-8;

[[noreturn]] void fail(const std::string& message, const std::string& hint) {
  throw BakeError(Problem{Severity::Error, "linear.no-eigenvectors", {}, message, hint});
}

/// One component as a mesh of its own.
struct Piece {
  std::vector<int> vertices;  ///< in the whole mesh, rising
  OneRings rings;
  Eigen::SparseMatrix<double> laplacian;
  Eigen::VectorXd root;  ///< Deg^1/2
  int wanted = 0;        ///< pairs

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
    OneRings& own = piece.rings;
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

/// A frequency with `count` eigenvalues below it, or a few more.
Enclosure enclose(SpectrumCount& spectrum, int count, const Observer& observer) {
  const int vertex_count = spectrum.vertex_count();
  const bool takes_all = is_dense(static_cast<std::size_t>(vertex_count), count);
  const int most = takes_all ? vertex_count : count + count / kExtraShare + 4;
  return spectrum.enclose(count, most, kSame, observer);
}

Eigenpairs solve_dense(const Piece& piece) {
  const auto vertex_count = static_cast<Eigen::Index>(piece.vertices.size());
  const Eigen::MatrixXd S = piece.apply(Eigen::MatrixXd::Identity(vertex_count, vertex_count));
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(S);
  if (solver.info() != Eigen::Success) fail("the dense eigenvalue solver failed", "");
  return {solver.eigenvalues().head(piece.wanted), solver.eigenvectors().leftCols(piece.wanted)};
}

Eigenpairs solve_piece(const Piece& piece, double lambda, const EigenvectorOptions& options,
                       const Observer& observer) {
  Eigenpairs pairs{Eigen::VectorXd::Zero(piece.wanted), {}};
  if (piece.wanted > 1 && is_dense(piece.vertices.size(), piece.wanted)) {
    pairs = solve_dense(piece);
  } else if (piece.wanted > 1) {
    pairs = eigenpairs_below(piece.rings, lambda, piece.wanted, options, observer);
    pairs.values = pairs.vectors.cwiseProduct(piece.apply(pairs.vectors)).colwise().sum();
  } else {
    pairs.vectors.resize(piece.root.size(), piece.wanted);
  }
  if (piece.wanted > 0) {
    pairs.values(0) = 0;
    pairs.vectors.col(0) = constant_eigenvector(piece.rings);
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

/// Whether `value` is the eigenvalue `other`, but for rounding.
bool is_same(double value, double other) { return value - other <= kSame * other; }

/// The smallest pairs of all components; equal ones in the order of the components.
std::vector<Place> smallest_places(const std::vector<Eigenpairs>& pairs, int count) {
  std::vector<Place> places;
  for (std::size_t p = 0; p < pairs.size(); ++p) {
    for (Eigen::Index k = 0; k < pairs[p].values.size(); ++k) {
      places.push_back({pairs[p].values(k), p, k});
    }
  }
  std::stable_sort(places.begin(), places.end(),
                   [](const Place& a, const Place& b) { return a.value < b.value; });
  auto end = static_cast<std::size_t>(count);
  while (end < places.size() && is_same(places[end].value, places[end - 1].value)) ++end;
  places.resize(end);
  return places;
}

SpectralBasis assemble(const std::vector<Piece>& pieces, const std::vector<Eigenpairs>& pairs,
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
  std::vector<Eigenpairs> pairs;
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

int whole_count(const SpectralBasis& basis, int count) {
  if (count == 0) return 0;
  while (count < basis.eigenvalues.size() &&
         is_same(basis.eigenvalues(count), basis.eigenvalues(count - 1))) {
    ++count;
  }
  return count;
}

}  // namespace morphbake
