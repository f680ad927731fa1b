#include <gtest/gtest.h>

#include <memory>

#include "morphbake/diagnostics/problem.h"
#include "morphbake/differential/laplacian.h"
#include "morphbake/files/files.h"
#include "morphbake/files/temporary_folder.h"
#include "morphbake/linear/cholesky_factor.h"
#include "morphbake/linear/iterate.h"
#include "morphbake/linear/multigrid.h"
#include "morphbake/linear/unknowns.h"
#include "shapes/shapes.h"

namespace morphbake {
namespace {

/// K_L of a sphere beside a torus: two singular blocks.
struct TwoBlocks {
  SymmetricSystem system;
  Eigen::MatrixXd known;
  Eigen::MatrixXd b;

  TwoBlocks() {
    const Mesh mesh = test::joined(test::sphere(8, 10), test::torus(10, 8));
    const Connectivity connectivity{static_cast<int>(mesh.positions.rows()), mesh.triangles};
    const OneRings rings = one_rings(connectivity);
    const Components components = connected_components(rings);
    system = {symmetric_laplacian(rings), components.label, components.count};
    known = mesh.positions;
    remove_block_means(system, known);
    b = system.matrix * known;
  }

  double error(Eigen::MatrixXd x) const {
    remove_block_means(system, x);
    return (x - known).rowwise().norm().maxCoeff();
  }
};

TEST(RemoveBlockMeans, LeavesDefiniteRowsAlone) {
  const SymmetricSystem system{{}, {0, -1, 0}, 1};
  Eigen::MatrixXd columns(3, 1);
  columns << 1, 5, 3;
  remove_block_means(system, columns);
  EXPECT_EQ(columns, (Eigen::MatrixXd(3, 1) << -1, 5, 1).finished());
}

TEST(Unknowns, LeaveOutWhatIsKnown) {
  const Unknowns unknowns({false, true, false, false});
  EXPECT_EQ(unknowns.of_row, (std::vector<int>{0, -1, 1, 2}));
  EXPECT_EQ(unknowns.rows, (std::vector<int>{0, 2, 3}));
  EXPECT_EQ(Eigen::VectorXd(unknowns.selection() * Eigen::Vector3d(5, 6, 7)),
            Eigen::VectorXd(Eigen::Vector4d(5, 0, 6, 7)));
  // Rows 0 and 1 are one part, of which one is known.
  const std::vector<int> parts = {0, 0, 1, 2};
  SymmetricSystem system;
  number_singular_blocks(unknowns, parts, unknown_parts(unknowns, parts, 3), system);
  EXPECT_EQ(system.singular_block, (std::vector<int>{-1, 0, 1}));
  EXPECT_EQ(system.singular_block_count, 2);
}

TEST(CholeskyFactor, SolvesEverySingularBlock) {
  const TwoBlocks two;
  const CholeskyFactor factor(two.system);
  EXPECT_LT(two.error(factor.solve(two.b)), 1e-12);
  EXPECT_GT(factor.bytes(), two.system.matrix.rows() * sizeof(double));
}

TEST(CholeskyFactor, SolvesTheSameInAnyOrder) {
  const TwoBlocks two;
  const CholeskyFactor dissected(two.system, Precision::Double, Ordering::NestedDissection);
  EXPECT_LT(two.error(dissected.solve(two.b)), 1e-12);
  EXPECT_EQ(cheaper_ordering(100000, 200), Ordering::MinimumDegree);
  EXPECT_EQ(cheaper_ordering(100000, 400), Ordering::NestedDissection);
}

TEST(CholeskyFactor, SolvesAsManyColumnsAsItIsGivenEachByItself) {
  const Mesh mesh = test::joined(test::torus(37, 23), test::sphere(9, 11));
  const OneRings rings = one_rings({static_cast<int>(mesh.positions.rows()), mesh.triangles});
  const Components components = connected_components(rings);
  const SymmetricSystem system{symmetric_laplacian(rings), components.label, components.count};
  const Eigen::Index rows = system.matrix.rows();
  for (const Precision precision : {Precision::Double, Precision::Single}) {
    const CholeskyFactor factor(system, precision);
    const double error = precision == Precision::Double ? 1e-12 : 1e-4;
    for (const Eigen::Index columns : {1, 4, 5, 9, 12, 24, 31, 49}) {
      Eigen::MatrixXd known(rows, columns);
      for (Eigen::Index c = 0; c < columns; ++c) {
        for (Eigen::Index r = 0; r < rows; ++r) {
          known(r, c) = std::sin(0.1 * static_cast<double>(r) + static_cast<double>(c));
        }
      }
      const Eigen::MatrixXd b = system.matrix * known;
      Eigen::MatrixXd difference = factor.solve(b) - known;
      remove_block_means(system, difference);
      EXPECT_LT(difference.cwiseAbs().maxCoeff(), error) << columns;
      const Eigen::MatrixXd last = factor.solve(b.rightCols(1));
      EXPECT_EQ(factor.solve(b).rightCols(1), last) << columns;
    }
  }
}

TEST(CholeskyFactor, OfSingleNumbersTakesHalfTheRoom) {
  const Mesh mesh = test::torus(60, 40);
  const OneRings rings = one_rings({static_cast<int>(mesh.positions.rows()), mesh.triangles});
  const SymmetricSystem system{symmetric_laplacian(rings), connected_components(rings).label, 1};
  const auto exact = static_cast<double>(CholeskyFactor(system).bytes());
  const auto single = static_cast<double>(CholeskyFactor(system, Precision::Single).bytes());
  EXPECT_LT(single, 0.6 * exact);
}

TEST(CholeskyFactor, IsTheSameByAnOrderThatWasKept) {
  const Mesh mesh = test::torus(220, 100);
  const OneRings rings = one_rings({static_cast<int>(mesh.positions.rows()), mesh.triangles});
  const SymmetricSystem system{symmetric_laplacian(rings), connected_components(rings).label, 1};
  const TemporaryFolder folder("order-test");
  const StageCache cache({folder.path(), std::uintmax_t{1} << 30});
  const Eigen::MatrixXd b = system.matrix * mesh.positions;
  for (const Ordering ordering : {Ordering::MinimumDegree, Ordering::NestedDissection}) {
    const int before = cache.contents().entries;
    const Eigen::MatrixXd found = CholeskyFactor(system, Precision::Double, ordering).solve(b);
    EXPECT_EQ(CholeskyFactor(system, Precision::Double, ordering, cache).solve(b), found);
    EXPECT_EQ(cache.contents().entries, before + 1);
    EXPECT_EQ(CholeskyFactor(system, Precision::Double, ordering, cache).solve(b), found);
    EXPECT_EQ(cache.contents().entries, before + 1);
  }
  // An entry that is whole but no order is passed over.
  for (const auto& file : std::filesystem::recursive_directory_iterator(folder.path())) {
    if (!file.is_regular_file()) continue;
    const std::string wrong(static_cast<std::size_t>(system.matrix.rows() - 1) * sizeof(int), '\0');
    replace_unsynced(file.path(), entry_to_bytes({"{}", {wrong}}));
  }
  EXPECT_EQ(CholeskyFactor(system, Precision::Double, Ordering::NestedDissection, cache).solve(b),
            CholeskyFactor(system, Precision::Double, Ordering::NestedDissection).solve(b));
}

TEST(CholeskyFactor, TakesASystemWithoutUnknowns) {
  const CholeskyFactor factor(SymmetricSystem{});
  EXPECT_EQ(factor.solve(Eigen::MatrixXd(0, 3)).rows(), 0);
  EXPECT_EQ(factor.bytes(), 0U);
}

TEST(CholeskyFactor, RefusesWhatIsNotDefinite) {
  SymmetricSystem system{Eigen::SparseMatrix<double>(2, 2), {-1, -1}, 0};
  system.matrix.insert(0, 0) = 1;
  system.matrix.insert(1, 1) = -1;
  EXPECT_THROW(CholeskyFactor{system}, BakeError);
}

class Iterations : public testing::TestWithParam<const char*> {
 protected:
  Iteration iteration(const TwoBlocks& two) const {
    const std::string name = GetParam();
    if (name == "jacobi") {
      return [&](const auto& b, const auto& stop, auto& x) {
        return iterate_jacobi(two.system, b, stop, x);
      };
    }
    if (name == "gauss-seidel") {
      return [&](const auto& b, const auto& stop, auto& x) {
        return iterate_gauss_seidel(two.system, b, stop, x);
      };
    }
    if (name == "pcg, multigrid") {
      const auto multigrid = std::make_shared<Multigrid>(two.system);
      return [&, multigrid](const auto& b, const auto& stop, auto& x) {
        const auto cycle = [&](const auto& r) { return Eigen::MatrixXd(multigrid->cycle(r)); };
        return iterate_conjugate_gradients(two.system, cycle, b, stop, x);
      };
    }
    const auto factor = std::make_shared<IncompleteFactor>(two.system);
    return [&, factor](const auto& b, const auto& stop, auto& x) {
      const auto by_factor = [&](const auto& r) { return factor->solve(r); };
      return iterate_conjugate_gradients(two.system, by_factor, b, stop, x);
    };
  }
};

TEST_P(Iterations, StopWithinTheTolerance) {
  const TwoBlocks two;
  const Iteration solve = iteration(two);
  StopRule stop;
  stop.tolerance = 1e-6;
  stop.max_iterations = 100000;
  stop.amplification = measure_amplification(two.system, solve, two.known, 100000);
  Eigen::MatrixXd x = Eigen::MatrixXd::Zero(two.b.rows(), 3);
  const Convergence convergence = solve(two.b, stop, x);
  EXPECT_TRUE(convergence.reached);
  EXPECT_LE(convergence.error, 1e-6);
  EXPECT_LT(two.error(x), 1e-6);
  EXPECT_LT(convergence.residual, 1e-5);
}

TEST_P(Iterations, SayWhenTheyDidNotConverge) {
  const TwoBlocks two;
  StopRule stop;
  stop.tolerance = 1e-9;
  stop.max_iterations = 3;
  Eigen::MatrixXd x = Eigen::MatrixXd::Zero(two.b.rows(), 3);
  const Convergence convergence = iteration(two)(two.b, stop, x);
  EXPECT_FALSE(convergence.reached);
  EXPECT_EQ(convergence.iterations, 3);
  EXPECT_GT(convergence.error, 1e-9);
}

TEST_P(Iterations, NeedNothingFromTheSolutionOn) {
  const TwoBlocks two;
  StopRule stop;
  stop.tolerance = 1e-9;
  stop.max_iterations = 100;
  Eigen::MatrixXd x = two.known;
  const Convergence convergence = iteration(two)(two.b, stop, x);
  EXPECT_TRUE(convergence.reached);
  EXPECT_LE(convergence.iterations, 32);
}

INSTANTIATE_TEST_SUITE_P(Methods, Iterations,
                         testing::Values("jacobi", "gauss-seidel", "pcg, incomplete",
                                         "pcg, multigrid"));

TEST(Multigrid, NeedsAsManyStepsForLargeSystemsAsForSmall) {
  for (const int side : {40, 160}) {
    // With fans at the poles.
    const Mesh mesh = test::joined(test::torus(2 * side, side), test::sphere(20, 2 * side));
    const OneRings rings = one_rings({static_cast<int>(mesh.positions.rows()), mesh.triangles});
    const Components components = connected_components(rings);
    const SymmetricSystem system{symmetric_laplacian(rings), components.label, components.count};
    const Multigrid multigrid(system);
    Eigen::MatrixXd known = mesh.positions;
    remove_block_means(system, known);
    Eigen::MatrixXd x = Eigen::MatrixXd::Zero(known.rows(), 3);
    StopRule stop;
    stop.tolerance = 1e-9;
    stop.max_iterations = 60;
    const Convergence reached = iterate_conjugate_gradients(
        system, [&](const auto& r) { return Eigen::MatrixXd(multigrid.cycle(r)); },
        system.matrix * known, stop, x);
    remove_block_means(system, x);
    EXPECT_TRUE(reached.reached);
    EXPECT_LT(reached.iterations, 30) << known.rows() << " rows";
    EXPECT_LT((x - known).rowwise().norm().maxCoeff(), 1e-8);
    EXPECT_LT(multigrid.bytes(), CholeskyFactor(system).bytes() / 3);
  }
}

}  // namespace
}  // namespace morphbake
