#include "shapes/arap.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <Eigen/SVD>

#include "morphbake/differential/laplacian.h"
#include "morphbake/mesh/measures.h"

namespace morphbake::test {
namespace {

constexpr int kMostPasses = 5000;
constexpr double kStill = 1e-6;  // of the diagonal, a pass

/// The rotation R that minimises |to - R from|^2, of a covariance sum to from^T.
Eigen::Matrix3d best_rotation(const Eigen::Matrix3d& covariance) {
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(covariance,
                                              Eigen::ComputeFullU | Eigen::ComputeFullV);
  Eigen::Matrix3d U = svd.matrixU();
  if ((U * svd.matrixV().transpose()).determinant() < 0) U.col(2) *= -1;
  return U * svd.matrixV().transpose();
}

}  // namespace

ArapInterpolation::ArapInterpolation(const MorphableMesh& mesh)
    : mesh_(mesh), rings_(one_rings(mesh.connectivity)) {
  const Eigen::SparseMatrix<double> K = symmetric_laplacian(rings_);
  factor_.compute(Eigen::SparseMatrix<double>(K.bottomRightCorner(K.rows() - 1, K.cols() - 1)));
}

/// b of K_L V = b by the rotations that fit `positions` best.
Positions ArapInterpolation::target_differences(double t, const Positions& positions) const {
  const Positions &a = mesh_.geometries[0], &b = mesh_.geometries[1];
  std::vector<Eigen::Matrix3d> R, Q;
  for (Eigen::Index i = 0; i < positions.rows(); ++i) {
    const auto v = static_cast<std::size_t>(i);
    Eigen::Matrix3d from_a = Eigen::Matrix3d::Zero(), from_b = from_a;
    for (int n = rings_.offsets[v]; n < rings_.offsets[v + 1]; ++n) {
      const int j = rings_.neighbours[static_cast<std::size_t>(n)];
      const Eigen::Vector3d edge = (positions.row(i) - positions.row(j)).transpose();
      from_a += edge * (a.row(i) - a.row(j));
      from_b += edge * (b.row(i) - b.row(j));
    }
    R.push_back(best_rotation(from_a));
    Q.push_back(best_rotation(from_b));
  }
  Positions sums = Positions::Zero(positions.rows(), 3);
  for (Eigen::Index i = 0; i < positions.rows(); ++i) {
    const auto v = static_cast<std::size_t>(i);
    for (int n = rings_.offsets[v]; n < rings_.offsets[v + 1]; ++n) {
      const int j = rings_.neighbours[static_cast<std::size_t>(n)];
      const auto other = static_cast<std::size_t>(j);
      const Eigen::Vector3d by_a = (R[v] + R[other]) / 2 * (a.row(i) - a.row(j)).transpose();
      const Eigen::Vector3d by_b = (Q[v] + Q[other]) / 2 * (b.row(i) - b.row(j)).transpose();
      sums.row(i) += ((1 - t) * by_a + t * by_b).transpose();
    }
  }
  return sums;
}

Positions ArapInterpolation::at(double t, const Positions& start) const {
  Positions positions = start;
  const double still = kStill * bounding_diagonal(start);
  for (int pass = 0; pass < kMostPasses; ++pass) {
    const Positions b = target_differences(t, positions);
    Positions next(positions.rows(), 3);
    next.row(0).setZero();
    next.bottomRows(next.rows() - 1) = factor_.solve(Eigen::MatrixXd(b.bottomRows(b.rows() - 1)));
    next.rowwise() += positions.colwise().mean() - next.colwise().mean();
    const double moved = largest_distance(next, positions);
    positions = next;
    if (moved < still) break;
  }
  return positions;
}

}  // namespace morphbake::test
