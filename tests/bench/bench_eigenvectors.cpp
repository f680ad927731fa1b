// Eigenvectors: ours against Spectra's shift-invert mode on Eigen's SimplicialLDLT, as its manual
// has it. Without shift-invert Spectra did not end.

#include <Spectra/MatOp/SparseSymShiftSolve.h>
#include <Spectra/SymEigsShiftSolver.h>
#include <fmt/core.h>

#include <Eigen/SparseCholesky>
#include <cmath>
#include <random>
#include <stdexcept>
#include <string>

#include "bench/timing.h"
#include "morphbake/differential/laplacian.h"
#include "morphbake/linear/eigenvectors.h"
#include "morphbake/linear/spectrum_count.h"
#include "shapes/shapes.h"

namespace morphbake::bench {
namespace {

constexpr int kPairs = 200;

/// (S - sigma)^-1.
struct PlainInverse {
  using Scalar = double;  // NOLINT: Spectra's name for it
  const Eigen::SparseMatrix<double>& S;
  Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> factor;

  Eigen::Index rows() const { return S.rows(); }

  Eigen::Index cols() const { return S.cols(); }

  void set_shift(double sigma) {
    Eigen::SparseMatrix<double> shifted = S;
    shifted.diagonal().array() -= sigma;
    factor.compute(shifted);
  }

  void perform_op(const double* in, double* out) const {
    Eigen::Map<Eigen::VectorXd>(out, rows()) =
        factor.solve(Eigen::Map<const Eigen::VectorXd>(in, rows()));
  }
};

Eigen::VectorXd plain_eigenvalues(const OneRings& rings) {
  const Eigen::VectorXd scale = spectral_degrees(rings).cwiseSqrt().cwiseInverse();
  const Eigen::SparseMatrix<double> S =
      scale.asDiagonal() * symmetric_laplacian(rings) * scale.asDiagonal();
  PlainInverse inverse{S, {}};
  Spectra::SymEigsShiftSolver<PlainInverse> solver(inverse, kPairs, 2 * kPairs, -1e-6);
  solver.init();
  solver.compute(Spectra::SortRule::LargestMagn, 1000, 1e-12, Spectra::SortRule::SmallestAlge);
  const Eigen::MatrixXd vectors = solver.eigenvectors();  // part of the work
  if (vectors.cols() != kPairs) throw std::runtime_error("the plain solver did not converge");
  return solver.eigenvalues();
}

/// The torus with one diagonal of each quad, by chance: as any mesh that nobody drew by rule.
Mesh irregular(Mesh torus) {
  std::minstd_rand random(1);
  for (Eigen::Index t = 0; t + 1 < torus.triangles.rows(); t += 2) {
    if (random() % 2 == 0) continue;
    const Eigen::RowVector3i first = torus.triangles.row(t);
    const int fourth = torus.triangles(t + 1, 2);
    torus.triangles.row(t) << first(0), first(1), fourth;
    torus.triangles.row(t + 1) << first(1), first(2), fourth;
  }
  return torus;
}

void compare(const Mesh& mesh, const std::string& group, Figures& figures) {
  const OneRings rings = one_rings({static_cast<int>(mesh.positions.rows()), mesh.triangles});
  SpectralBasis basis;
  Eigen::VectorXd plain;
  const double ours = seconds_of([&] { basis = smallest_eigenvectors(rings, kPairs); });
  const double theirs = seconds_of([&] { plain = plain_eigenvalues(rings); });
  figures.push_back({group, "ours", ours, "s",
                     fmt::format("largest residual {:.0e}", basis.residuals.maxCoeff())});
  figures.push_back({group, "Spectra's SymEigsShiftSolver on Eigen's SimplicialLDLT", theirs, "s",
                     fmt::format("eigenvalues differ by {:.0e}",
                                 (plain - basis.eigenvalues.head(kPairs)).cwiseAbs().maxCoeff())});
  figures.push_back({group, "plain / ours", theirs / ours, "x", "one run each"});
  int count = 0;
  SpectrumCount spectrum(rings);
  const double counting = seconds_of(
      [&] { count = spectrum.below(basis.eigenvalues(kPairs / 2) * (1 + 1e-6)).total(); });
  figures.push_back(
      {group, "counting eigenvalues below one", counting, "s", fmt::format("{}", count)});
}

}  // namespace

void bench_eigenvectors(int vertices, Figures& figures) {
  const int side = static_cast<int>(std::sqrt(vertices / 2.0));
  const Mesh torus = test::torus(2 * side, side);
  const std::string group =
      fmt::format("{} eigenvectors, {} vertices", kPairs, shown_count(vertices));
  compare(irregular(torus), group, figures);
  compare(torus, group + ", each eigenvalue two to twelve times", figures);
}

}  // namespace morphbake::bench
