// L^T L squares the condition number: at 100,000 vertices float64 alone would keep 8 digits. The
// solution is compared with one that is refined in quadruple precision.

#include <fmt/core.h>
#include <gtest/gtest.h>

#include <Eigen/SparseCholesky>
#include <algorithm>
#include <array>

#include "morphbake/mesh/measures.h"
#include "morphbake/solve/solve_fields.h"
#include "shapes/shapes.h"

namespace morphbake {
namespace {

using Quad = __float128;  // NOLINT(bugprone-reserved-identifier)
using QuadRow = std::array<Quad, 3>;

/// A torus and a bent copy; the half with x > -0.3 changes, softly.
struct Half {
  MorphableMesh mesh;
  Eigen::MatrixXd change;
  OneRings rings;

  explicit Half(int side) {
    const Mesh torus = test::torus(2 * side, side);
    mesh = test::morphable(torus.triangles, {torus.positions, test::bent(torus.positions, 0.3, 9)});
    rings = one_rings(mesh.connectivity);
    change.setZero(2, torus.positions.rows());
    for (Eigen::Index v = 0; v < change.cols(); ++v) {
      const double share = std::clamp((torus.positions(v, 0) + 0.3) / 0.8, 0.0, 1.0);
      change.col(v) << -share, share;
    }
  }

  template <typename Visit>
  void for_each_neighbour(int i, const Visit& visit) const {
    const auto v = static_cast<std::size_t>(i);
    for (int n = rings.offsets[v]; n < rings.offsets[v + 1]; ++n) {
      visit(rings.neighbours[static_cast<std::size_t>(n)]);
    }
  }
};

/// The least squares in quadruple precision, corrected by a float64 LDL^T of Eigen's.
class QuadrupleSolution {
 public:
  QuadrupleSolution(const Half& half, const std::vector<bool>& held) : half_(half) {
    const int count = half.mesh.connectivity.vertex_count;
    unknown_.assign(static_cast<std::size_t>(count), -1);
    for (int v = 0; v < count; ++v) {
      if (!held[static_cast<std::size_t>(v)]) {
        unknown_[static_cast<std::size_t>(v)] = static_cast<int>(vertices_.size());
        vertices_.push_back(v);
      }
    }
    u_.assign(static_cast<std::size_t>(count), QuadRow{0, 0, 0});
    factorise();
  }

  /// @return  largest correction of the last round
  double refine() {
    const std::vector<QuadRow> e = misfit();
    Eigen::MatrixXd r(static_cast<Eigen::Index>(vertices_.size()), 3);
    for (std::size_t k = 0; k < vertices_.size(); ++k) {
      QuadRow sum = e[static_cast<std::size_t>(vertices_[k])];
      half_.for_each_neighbour(vertices_[k], [&](int j) {
        for (std::size_t c = 0; c < 3; ++c) {
          sum[c] -= e[static_cast<std::size_t>(j)][c] / half_.rings.degree(j);
        }
      });
      for (int c = 0; c < 3; ++c) {
        r(static_cast<Eigen::Index>(k), c) = static_cast<double>(sum[static_cast<std::size_t>(c)]);
      }
    }
    const Eigen::MatrixXd correction = factor_.solve(r);
    for (std::size_t k = 0; k < vertices_.size(); ++k) {
      for (std::size_t c = 0; c < 3; ++c) {
        u_[static_cast<std::size_t>(vertices_[k])][c] +=
            correction(static_cast<Eigen::Index>(k), static_cast<Eigen::Index>(c));
      }
    }
    return correction.rowwise().norm().maxCoeff();
  }

  Positions displacement() const {
    Positions rows(static_cast<Eigen::Index>(u_.size()), 3);
    for (Eigen::Index v = 0; v < rows.rows(); ++v) {
      for (int c = 0; c < 3; ++c) {
        rows(v, c) =
            static_cast<double>(u_[static_cast<std::size_t>(v)][static_cast<std::size_t>(c)]);
      }
    }
    return rows;
  }

 private:
  void factorise() {
    std::vector<Eigen::Triplet<double>> entries;
    const auto add = [&](int row, int vertex, double value) {
      const int unknown = unknown_[static_cast<std::size_t>(vertex)];
      if (unknown >= 0) entries.emplace_back(row, unknown, value);
    };
    const int count = half_.mesh.connectivity.vertex_count;
    for (int i = 0; i < count; ++i) {
      add(i, i, 1);
      half_.for_each_neighbour(i, [&](int j) { add(i, j, -1.0 / half_.rings.degree(i)); });
    }
    Eigen::SparseMatrix<double> L_F(count, static_cast<Eigen::Index>(vertices_.size()));
    L_F.setFromTriplets(entries.begin(), entries.end());
    factor_.compute(L_F.transpose() * L_F);
  }

  void add_edge(int i, int j, QuadRow& sum) const {
    for (int c = 0; c < 3; ++c) {
      const auto k = static_cast<std::size_t>(c);
      for (int s = 0; s < 2; ++s) {
        const Positions& V = half_.mesh.geometries[static_cast<std::size_t>(s)];
        const Quad share = (Quad(half_.change(s, i)) + Quad(half_.change(s, j))) / 2;
        sum[k] += share * (Quad(V(i, c)) - Quad(V(j, c)));
      }
      sum[k] -= u_[static_cast<std::size_t>(i)][k] - u_[static_cast<std::size_t>(j)][k];
    }
  }

  /// Deg^-1 b(dT) - L u with eq. 6's differences blended along edges.
  std::vector<QuadRow> misfit() const {
    std::vector<QuadRow> e(u_.size(), QuadRow{0, 0, 0});
    for (int i = 0; i < static_cast<int>(u_.size()); ++i) {
      const auto v = static_cast<std::size_t>(i);
      half_.for_each_neighbour(i, [&](int j) { add_edge(i, j, e[v]); });
      for (Quad& component : e[v]) component /= half_.rings.degree(i);
    }
    return e;
  }

  const Half& half_;
  std::vector<int> unknown_;
  std::vector<int> vertices_;
  std::vector<QuadRow> u_;
  Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> factor_;
};

TEST(HoldAt100k, IsAccurateTo1e9OfTheDiagonal) {
  const Half half(224);
  const SeparableTimeline timeline{Shares(0, 1), {{"", half.change, {}}}};
  const Constraints constraints = choose_constraints(half.mesh, connected_components(half.rings),
                                                     untouched_vertices(timeline), {});
  const DisplacementSystem system(half.mesh, constraints, RightHandSide::Edge);
  const Observer nobody;
  const SurfaceSolver solver(system, {}, nobody);
  std::vector<SolveRecord> records;
  const Positions moved = solve_change(solver, half.change, "", records);

  QuadrupleSolution exact(half, constraints.held);
  double correction = 1;
  for (int round = 0; round < 12 && correction > 1e-13; ++round) correction = exact.refine();
  ASSERT_LT(correction, 1e-13);
  const double error = largest_distance(moved, exact.displacement()) / system.diagonal();
  fmt::print("{} vertices, {} unknowns, {} correction(s): error {:.1e}, estimated {:.1e}\n",
             half.mesh.connectivity.vertex_count, system.equations().matrix.rows(),
             records[0].convergence.iterations, error,
             records[0].convergence.error / system.diagonal());
  EXPECT_LT(error, 1e-9);
  EXPECT_LT(error, 10 * records[0].convergence.error / system.diagonal());
}

}  // namespace
}  // namespace morphbake
