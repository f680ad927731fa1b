#include "morphbake/linear/eigenvectors.h"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "morphbake/diagnostics/problem.h"
#include "morphbake/differential/laplacian.h"
#include "morphbake/linear/spectrum_count.h"
#include "shapes/shapes.h"

namespace morphbake {
namespace {

OneRings rings_of(const Mesh& mesh) {
  return one_rings({static_cast<int>(mesh.positions.rows()), mesh.triangles});
}

std::vector<double> sorted(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return values;
}

/// Eigenvalues of test::torus: every vertex (r, s) has the neighbours (r +- 1, s), (r, s +- 1),
/// (r + 1, s + 1) and (r - 1, s - 1), so waves are eigenvectors.
std::vector<double> torus_spectrum(int rings, int segments) {
  std::vector<double> values;
  for (int r = 0; r < rings; ++r) {
    for (int s = 0; s < segments; ++s) {
      const double a = 2 * std::numbers::pi * r / rings, b = 2 * std::numbers::pi * s / segments;
      values.push_back(1 - (std::cos(a) + std::cos(b) + std::cos(a + b)) / 3);
    }
  }
  return sorted(values);
}

std::vector<double> dense_spectrum(const OneRings& rings) {
  const Eigen::VectorXd scale = spectral_degrees(rings).cwiseSqrt().cwiseInverse();
  const Eigen::MatrixXd S =
      scale.asDiagonal() * Eigen::MatrixXd(symmetric_laplacian(rings)) * scale.asDiagonal();
  const Eigen::VectorXd values = Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(S).eigenvalues();
  return {values.begin(), values.end()};
}

/// Orthonormal, small residuals by an independent computation, and the smallest of `spectrum`.
void expect_smallest(const OneRings& rings, const SpectralBasis& basis,
                     const std::vector<double>& spectrum) {
  const Eigen::Index count = basis.eigenvalues.size();
  const Eigen::VectorXd degrees = spectral_degrees(rings);
  const Eigen::MatrixXd& vectors = basis.vectors;
  const Eigen::MatrixXd gram = vectors.transpose() * degrees.asDiagonal() * vectors;
  EXPECT_LT((gram - Eigen::MatrixXd::Identity(count, count)).cwiseAbs().maxCoeff(), 1e-10);
  const Eigen::MatrixXd misfit = symmetric_laplacian(rings) * vectors -
                                 degrees.asDiagonal() * vectors * basis.eigenvalues.asDiagonal();
  EXPECT_LT(misfit.colwise().norm().maxCoeff(), 1e-9);
  for (Eigen::Index k = 0; k < count; ++k) {
    EXPECT_NEAR(basis.eigenvalues(k), spectrum[static_cast<std::size_t>(k)], 1e-10) << k;
  }
}

TEST(SmallestEigenvectors, RefuseACountThatTheMeshDoesNotHave) {
  const OneRings rings = rings_of(test::tetrahedron());
  EXPECT_THROW(smallest_eigenvectors(rings, 0), BakeError);
  EXPECT_THROW(smallest_eigenvectors(rings, 5), BakeError);
  EXPECT_THROW(smallest_eigenvectors(one_rings({0, {}}), 1), BakeError);
}

TEST(SmallestEigenvectors, SayWhenTheyDoNotConverge) {
  EigenvectorOptions options;
  options.tolerance = 1e-30;
  options.max_restarts = 1;
  try {
    smallest_eigenvectors(rings_of(test::torus(40, 30)), 20, options);
    FAIL() << "no error";
  } catch (const BakeError& error) {
    EXPECT_EQ(error.problems().front().code, "linear.no-eigenvectors");
  }
}

TEST(SmallestEigenvectors, StopWhenAsked) {
  Observer observer;
  observer.is_cancelled = [] { return true; };
  EXPECT_THROW(smallest_eigenvectors(rings_of(test::torus(40, 30)), 20, {}, observer), Cancelled);
}

TEST(SmallestEigenvectors, OfATorusAreWaves) {
  const OneRings rings = rings_of(test::torus(40, 30));
  expect_smallest(rings, smallest_eigenvectors(rings, 60), torus_spectrum(40, 30));
}

TEST(SmallestEigenvectors, MissNoneOfATwelvefoldEigenvalue) {
  const OneRings rings = rings_of(test::torus(30, 30));
  expect_smallest(rings, smallest_eigenvectors(rings, 100), torus_spectrum(30, 30));
}

TEST(SmallestEigenvectors, AreAllThereWhenAllAreAskedFor) {
  const OneRings rings = rings_of(test::torus(12, 8));
  expect_smallest(rings, smallest_eigenvectors(rings, 96), torus_spectrum(12, 8));
}

TEST(SmallestEigenvectors, OfASphereWhosePolesHaveLargeDegrees) {
  const OneRings rings = rings_of(test::sphere(25, 30));
  expect_smallest(rings, smallest_eigenvectors(rings, 50), dense_spectrum(rings));
}

TEST(SmallestEigenvectors, OfManyEqualComponents) {
  Mesh mesh = test::torus(30, 20);
  for (int k = 0; k < 3; ++k) mesh = test::joined(mesh, mesh);
  const OneRings rings = rings_of(mesh);
  std::vector<double> spectrum;
  for (const double value : torus_spectrum(30, 20)) {
    spectrum.insert(spectrum.end(), 8, value);
  }
  const SpectralBasis basis = smallest_eigenvectors(rings, 150);
  expect_smallest(rings, basis, spectrum);
  EXPECT_EQ((basis.eigenvalues.array() == 0).count(), 8);
}

TEST(SmallestEigenvectors, OfComponentsOfOtherSizes) {
  const Mesh mesh = test::joined(test::joined(test::tetrahedron(), test::sphere(25, 20)),
                                 test::joined(test::torus(12, 10), test::grid(2, 2)));
  const OneRings rings = rings_of(mesh);
  const std::vector<double> spectrum = dense_spectrum(rings);
  expect_smallest(rings, smallest_eigenvectors(rings, 3), spectrum);
  expect_smallest(rings, smallest_eigenvectors(rings, 40), spectrum);
  expect_smallest(rings, smallest_eigenvectors(rings, static_cast<int>(spectrum.size())), spectrum);
}

TEST(SmallestEigenvectors, TakeVerticesWithoutTriangles) {
  const OneRings rings = one_rings({5, test::tetrahedron().triangles});
  const SpectralBasis basis = smallest_eigenvectors(rings, 5);
  expect_smallest(rings, basis, {0, 0, 4 / 3.0, 4 / 3.0, 4 / 3.0});
  EXPECT_EQ(basis.vectors(4, 1), 1);
}

TEST(SmallestEigenvectors, AreTheSameEveryTime) {
  const OneRings rings = rings_of(test::torus(40, 30));
  const SpectralBasis first = smallest_eigenvectors(rings, 30);
  const SpectralBasis second = smallest_eigenvectors(rings, 30);
  EXPECT_EQ(first.vectors, second.vectors);
  EXPECT_EQ(first.eigenvalues, second.eigenvalues);
}

/// A strip is nearly a path: its eigenvalues grow with the square of their index.
TEST(SmallestEigenvectors, OfALongStrip) {
  const OneRings rings = rings_of(test::grid(300, 2));
  expect_smallest(rings, smallest_eigenvectors(rings, 40), dense_spectrum(rings));
}

TEST(SpectrumCount, CountsEveryEigenvalue) {
  SpectrumCount spectrum(rings_of(test::torus(20, 12)));
  const std::vector<double> values = torus_spectrum(20, 12);
  EXPECT_EQ(spectrum.below(0).total(), 0);
  EXPECT_EQ(spectrum.below(1e-9).total(), 1);
  EXPECT_EQ(spectrum.below(2.1).total(), 240);
  for (std::size_t k = 0; k + 1 < values.size(); ++k) {
    if (values[k + 1] - values[k] < 1e-6) continue;
    const double between = (values[k] + values[k + 1]) / 2;
    EXPECT_EQ(spectrum.below(between).total(), static_cast<int>(k + 1)) << between;
  }
}

TEST(SpectrumCount, StepsAsideWhereEveryPivotVanishes) {
  // At 1 the diagonal of K_L - Deg is 0 everywhere. No eigenvalue lies within 1e-4 above.
  const std::vector<double> values = torus_spectrum(20, 13);
  const Enclosure found = SpectrumCount(rings_of(test::torus(20, 13))).below(1);
  EXPECT_GT(found.lambda, 1);
  EXPECT_LE(found.lambda, 1 + 1e-4);
  EXPECT_EQ(found.total(),
            std::count_if(values.begin(), values.end(), [](double v) { return v < 1; }));
}

TEST(SpectrumCount, CountsVerticesWithoutTriangles) {
  SpectrumCount spectrum(one_rings({6, test::tetrahedron().triangles}));
  EXPECT_EQ(spectrum.below(1e-12).counts, (std::vector<int>{1, 1, 1}));
  EXPECT_EQ(spectrum.below(1.4).counts, (std::vector<int>{4, 1, 1}));
}

TEST(SpectrumCount, CountsByComponent) {
  SpectrumCount spectrum(rings_of(test::joined(test::tetrahedron(), test::torus(20, 12))));
  EXPECT_EQ(spectrum.below(1.3).counts,
            (std::vector<int>{1, SpectrumCount(rings_of(test::torus(20, 12))).below(1.3).total()}));
  EXPECT_EQ(spectrum.below(1.4).counts[0], 4);
}

}  // namespace
}  // namespace morphbake
