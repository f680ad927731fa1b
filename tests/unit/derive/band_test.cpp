#include "morphbake/derive/band.h"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <cmath>
#include <numbers>
#include <string>

#include "morphbake/diagnostics/problem.h"
#include "morphbake/differential/laplacian.h"
#include "morphbake/linear/spectrum_count.h"
#include "morphbake/mesh/measures.h"
#include "shapes/shapes.h"

namespace morphbake {
namespace {

constexpr double kPi = std::numbers::pi;

OneRings rings_of(const Mesh& mesh) {
  return one_rings({static_cast<int>(mesh.positions.rows()), mesh.triangles});
}

Mesh bent_torus(int rings, int segments) {
  Mesh mesh = test::torus(rings, segments);
  mesh.positions = test::bent(mesh.positions, 0.3, 5).rowwise() + Eigen::RowVector3d(3, -1, 2);
  return mesh;
}

int last_of(const Mesh& mesh) { return static_cast<int>(mesh.positions.rows()) - 1; }

/// The first `count` eigenvectors' part, by a dense solver on S.
Positions dense_low_pass(const Mesh& mesh, int count) {
  const OneRings rings = rings_of(mesh);
  const Eigen::VectorXd root = spectral_degrees(rings).cwiseSqrt();
  const Eigen::VectorXd inverse = root.cwiseInverse();
  const Eigen::MatrixXd S =
      inverse.asDiagonal() * Eigen::MatrixXd(symmetric_laplacian(rings)) * inverse.asDiagonal();
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(S);
  const Eigen::MatrixXd vectors = solver.eigenvectors().leftCols(count);
  return inverse.asDiagonal() *
         (vectors * (vectors.transpose() * (root.asDiagonal() * mesh.positions)));
}

Eigen::RowVector3d weighted_mean(const Mesh& mesh, Eigen::Index first, Eigen::Index count) {
  const Eigen::VectorXd weights = spectral_degrees(rings_of(mesh)).segment(first, count);
  return weights.transpose() * mesh.positions.middleRows(first, count) / weights.sum();
}

class BandOutOfRange : public testing::TestWithParam<Band> {};

TEST_P(BandOutOfRange, IsToldWithCounts) {
  try {
    band_limited(test::tetrahedron(), GetParam());
    FAIL() << "no error";
  } catch (const BakeError& error) {
    EXPECT_EQ(error.problems()[0].code, "derive.band-out-of-range");
    EXPECT_NE(error.problems()[0].message.find("a mesh with 4 eigenvectors"), std::string::npos);
  }
}

INSTANTIATE_TEST_SUITE_P(Band, BandOutOfRange,
                         testing::Values(Band{-1, 2}, Band{2, 1}, Band{0, 4}, Band{4, 5}));

TEST(Band, OfNothingIsOutOfRange) {
  EXPECT_THROW(band_limited(Mesh{Positions(0, 3), Triangles(0, 3)}, {0, 0}), BakeError);
}

TEST(Band, OfEverythingIsTheSource) {
  for (const Mesh& mesh : {bent_torus(12, 10), bent_torus(50, 40)}) {
    EXPECT_EQ(band_limited(mesh, {0, last_of(mesh)}), mesh.positions);
  }
}

TEST(Band, AllEigenvectorsReproduceTheSource) {
  const Mesh mesh =
      test::joined(bent_torus(20, 15), test::joined(test::sphere(12, 14), test::tetrahedron()));
  const OneRings rings = rings_of(mesh);
  const auto count = static_cast<int>(mesh.positions.rows());
  const Positions all = projected(smallest_eigenvectors(rings, count), spectral_degrees(rings),
                                  count, mesh.positions);
  EXPECT_LT(largest_distance(all, mesh.positions), 1e-9 * bounding_diagonal(mesh.positions));
}

TEST(Band, LowPassEqualsADenseProjection) {
  const Mesh mesh = bent_torus(31, 17);
  // Eigenvalues come in pairs after the constant: cuts after an odd number of them.
  for (const int count : {1, 7, 31, 301}) {
    const Positions expected = dense_low_pass(mesh, count);
    EXPECT_LT(largest_distance(band_limited(mesh, {0, count - 1}), expected), 1e-9) << count;
  }
}

TEST(Band, CutsThroughAMultipleEigenvalueMoveBehindIt) {
  const Mesh small = bent_torus(31, 17), large = bent_torus(37, 29);
  for (const Mesh& mesh : {small, large}) {
    EXPECT_LT(largest_distance(band_limited(mesh, {0, 5}), dense_low_pass(mesh, 7)), 1e-9);
    EXPECT_LT(largest_distance(band_limited(mesh, {0, 49}), dense_low_pass(mesh, 51)), 1e-9);
  }
}

TEST(Band, LowPassOfALargerMeshUsesTheSparseSolver) {
  const Mesh mesh = bent_torus(37, 29);
  const Positions expected = dense_low_pass(mesh, 51);
  EXPECT_LT(largest_distance(band_limited(mesh, {0, 50}), expected), 1e-9);
  EXPECT_GT(largest_distance(mesh.positions, expected), 1e-3);
}

TEST(Band, BandsAddUpToTheSource) {
  const Mesh mesh = bent_torus(50, 40);
  const Positions mean = weighted_mean(mesh, 0, 2000).replicate(2000, 1);
  const Positions sum = band_limited(mesh, {0, 20}) + band_limited(mesh, {21, 700}) +
                        band_limited(mesh, {701, 1999}) - 2 * mean;
  EXPECT_LT(largest_distance(sum, mesh.positions), 1e-11);
}

TEST(Band, ComponentsKeepTheirMeans) {
  const Mesh mesh = test::joined(bent_torus(20, 15), test::sphere(12, 14));
  const Mesh high{band_limited(mesh, {50, last_of(mesh)}), mesh.triangles};
  EXPECT_LT((weighted_mean(high, 0, 300) - weighted_mean(mesh, 0, 300)).norm(), 1e-12);
  EXPECT_LT((weighted_mean(high, 300, 156) - weighted_mean(mesh, 300, 156)).norm(), 1e-12);
  const Positions means = band_limited(mesh, {0, 0});
  EXPECT_LT((means.row(0) - weighted_mean(mesh, 0, 300)).norm(), 1e-12);
  EXPECT_LT((means.row(455) - weighted_mean(mesh, 300, 156)).norm(), 1e-12);
}

/// A torus whose coordinates are waves: eigenvectors of known frequency.
struct Waves {
  static constexpr int kRings = 64, kSegments = 40;
  Mesh mesh = test::torus(kRings, kSegments);
  double frequencies[3] = {};  ///< acos(1 - lambda)

  /// Around the torus, around its tube, and along diagonals.
  explicit Waves(int count) {
    add(0, count, 0);
    add(1, 0, count);
    add(2, count, count * kSegments / kRings);
  }

 private:
  void add(int column, int i, int j) {
    const double a = 2 * kPi * i / kRings, b = 2 * kPi * j / kSegments;
    for (int v = 0; v < mesh.positions.rows(); ++v) {
      const double r = v / kSegments, s = v % kSegments;
      mesh.positions(v, column) = std::cos(a * r + b * s + 0.3);
    }
    frequencies[column] = std::acos((std::cos(a) + std::cos(b) + std::cos(a + b)) / 3);
  }
};

/// What is left of a wave, and what else came in.
double largest_entry(const Positions& positions, int column) {
  return positions.col(column).cwiseAbs().maxCoeff();
}

TEST(Band, FilterLeaksNoMoreThanItSays) {
  const OneRings rings = rings_of(test::torus(Waves::kRings, Waves::kSegments));
  BandOptions options;
  options.exact_limit = 0;
  for (const int count : {100, 600, 1500}) {
    SpectrumCount spectrum(rings);
    const double cut = std::acos(1 - spectrum.enclose(count, count, 1e-6, {}).lambda);
    // The cut itself is found to a twentieth of the transition.
    const double margin = 1.05 * options.transition * cut;
    int kept = 0, removed = 0;
    for (int waves = 1; waves < 22; waves += 2) {
      const Waves source(waves);
      const Positions low = band_limited(source.mesh, {0, count - 1}, options);
      for (int k = 0; k < 3; ++k) {
        if (source.frequencies[k] < cut - margin) {
          EXPECT_LT(largest_entry(low - source.mesh.positions, k), 1e-4) << count << " " << waves;
          ++kept;
        } else if (source.frequencies[k] > cut + margin) {
          EXPECT_LT(largest_entry(low, k), 1e-4) << count << " " << waves;
          ++removed;
        }
      }
    }
    EXPECT_GT(kept, 3) << count;
    EXPECT_GT(removed, 1) << count;
  }
}

TEST(Band, FilterOfTooLowADegreeIsWiderNotWorse) {
  BandOptions options;
  options.exact_limit = 0;
  options.max_degree = 60;
  const Waves low_waves(3), high_waves(14);
  EXPECT_LT((band_limited(low_waves.mesh, {0, 400}, options) - low_waves.mesh.positions)
                .cwiseAbs()
                .maxCoeff(),
            1e-3);
  EXPECT_LT(band_limited(high_waves.mesh, {0, 400}, options).col(2).cwiseAbs().maxCoeff(), 1e-3);
}

TEST(Band, StopsWhenAsked) {
  Observer observer;
  observer.is_cancelled = [] { return true; };
  const Mesh mesh = bent_torus(50, 40);
  EXPECT_THROW(band_limited(mesh, {0, 100}, {}, observer), Cancelled);
  EXPECT_THROW(band_limited(mesh, {0, 900}, {}, observer), Cancelled);
}

TEST(Band, GivesNumbersOnDegenerateMeshes) {
  Mesh mesh = test::joined(test::torus(40, 30), test::grid(2, 2));
  mesh.positions.topRows(1200).setConstant(7);  // all in one point
  mesh.positions.bottomRows(4).col(1) *= 1e-14;
  Mesh loose = mesh;
  loose.positions.conservativeResize(1206, 3);  // two vertices without triangles
  loose.positions.bottomRows(2).setConstant(-3);
  BandOptions filter;
  filter.exact_limit = 0;
  for (const BandOptions& options : {BandOptions{}, filter}) {
    for (const Band band : {Band{0, 1}, Band{5, 40}, Band{30, 1205}, Band{1204, 1204}}) {
      const Positions result = band_limited(loose, band, options);
      EXPECT_TRUE(result.allFinite());
      EXPECT_LT((result.topRows(1200).array() - 7).abs().maxCoeff(), 1e-12);
      EXPECT_EQ(result.bottomRows(2), loose.positions.bottomRows(2));
    }
  }
}

}  // namespace
}  // namespace morphbake
