#include "morphbake/solve/affine_blend.h"

#include <Eigen/Cholesky>
#include <Eigen/SparseCore>
#include <cmath>
#include <utility>

#include "morphbake/differential/laplacian.h"
#include "morphbake/linear/cholesky_factor.h"

namespace morphbake {
namespace {

constexpr double kTowardsUniform = 0.2;  // of the mean edge
constexpr double kLaplacian = 0.03;

}  // namespace

AffineBlend::Weights AffineBlend::weights_of(const OneRings& rings, const Positions& positions) {
  Weights weights;
  weights.differences = differential_coordinates(rings, positions);
  weights.missed = Positions::Zero(positions.rows(), 3);
  weights.of_neighbours.resize(rings.neighbours.size());
  for (Eigen::Index i = 0; i < positions.rows(); ++i) {
    const auto begin = static_cast<std::size_t>(rings.offsets[static_cast<std::size_t>(i)]);
    const auto end = static_cast<std::size_t>(rings.offsets[static_cast<std::size_t>(i) + 1]);
    if (begin == end) continue;
    const Eigen::RowVector3d mean = positions.row(i) - weights.differences.row(i);
    Eigen::Matrix3d squares = Eigen::Matrix3d::Zero();
    double length = 0;
    for (std::size_t n = begin; n < end; ++n) {
      const Eigen::Vector3d from_mean = (positions.row(rings.neighbours[n]) - mean).transpose();
      squares += from_mean * from_mean.transpose();
      length += (positions.row(rings.neighbours[n]) - positions.row(i)).norm();
    }
    const auto count = static_cast<double>(end - begin);
    const double pull = std::pow(kTowardsUniform * length / count, 2);
    Eigen::Vector3d y = Eigen::Vector3d::Zero();
    if (pull > 0) {
      const Eigen::Matrix3d pulled = squares + pull * Eigen::Matrix3d::Identity();
      y = pulled.ldlt().solve(weights.differences.row(i).transpose());
    }
    for (std::size_t n = begin; n < end; ++n) {
      weights.of_neighbours[n] = 1 / count + (positions.row(rings.neighbours[n]) - mean) * y;
    }
    weights.missed.row(i) = weights.differences.row(i) - (squares * y).transpose();
  }
  return weights;
}

AffineBlend::AffineBlend(const MorphableMesh& mesh, const Constraints& constraints, Positions rest)
    : rings_(one_rings(mesh.connectivity)),
      components_(connected_components(rings_)),
      unknowns_(constraints.held),
      is_free_(unknown_parts(unknowns_, components_.label, components_.count)),
      select_(unknowns_.selection()),
      gauge_(constraints.gauge),
      rest_(std::move(rest)) {
  for (const Positions& source : mesh.geometries) weights_.push_back(weights_of(rings_, source));
  const Eigen::SparseMatrix<double> K_L = symmetric_laplacian(rings_);
  const Eigen::VectorXd degrees = K_L.diagonal().cwiseMax(1);
  laplacian_ = degrees.cwiseInverse().asDiagonal() * K_L;
  const Eigen::SparseMatrix<double> L_F = laplacian_ * select_;
  const Eigen::SparseMatrix<double> L_F_transposed = L_F.transpose();
  regularisation_.matrix = kLaplacian * (L_F_transposed * L_F);
  number_singular_blocks(unknowns_, components_.label, is_free_, regularisation_);
}

/// I - W with the sources' weights blended: #V by #V.
Eigen::SparseMatrix<double> AffineBlend::affine_matrix(const TransitionState& T) const {
  std::vector<Eigen::Triplet<double>> entries;
  for (Eigen::Index i = 0; i < T.cols(); ++i) {
    const auto v = static_cast<std::size_t>(i);
    if (rings_.degree(static_cast<int>(i)) > 0) entries.emplace_back(i, i, 1.0);
    for (int n = rings_.offsets[v]; n < rings_.offsets[v + 1]; ++n) {
      const auto neighbour = static_cast<std::size_t>(n);
      double weight = 0;
      for (std::size_t s = 0; s < weights_.size(); ++s) {
        weight += T(static_cast<Eigen::Index>(s), i) * weights_[s].of_neighbours[neighbour];
      }
      entries.emplace_back(i, rings_.neighbours[neighbour], -weight);
    }
  }
  Eigen::SparseMatrix<double> matrix(T.cols(), T.cols());
  matrix.setFromTriplets(entries.begin(), entries.end());
  return matrix;
}

/// Components that hold nothing stand where their mixed positions do.
void AffineBlend::move_to_gauge(const Positions& mixed, Positions& shape) const {
  Positions shift = Positions::Zero(components_.count, 3);
  for (Eigen::Index v = 0; v < shape.rows(); ++v) {
    shift.row(components_.label[static_cast<std::size_t>(v)]) +=
        gauge_(v) * (mixed.row(v) - shape.row(v));
  }
  for (const int vertex : unknowns_.rows) {
    const int component = components_.label[static_cast<std::size_t>(vertex)];
    if (is_free_[static_cast<std::size_t>(component)]) shape.row(vertex) += shift.row(component);
  }
}

Positions AffineBlend::shape(const TransitionState& T, const Positions& mixed) const {
  Positions missed = Positions::Zero(T.cols(), 3), differences = missed;
  for (std::size_t s = 0; s < weights_.size(); ++s) {
    const auto shares = T.row(static_cast<Eigen::Index>(s)).asDiagonal();
    missed += shares * weights_[s].missed;
    differences += shares * weights_[s].differences;
  }
  Positions shape = mixed;
  for (Eigen::Index row = 0; row < shape.rows(); ++row) {
    if (unknowns_.of_row[static_cast<std::size_t>(row)] < 0) shape.row(row) = rest_.row(row);
  }
  // Moves from there, not positions: squares lose digits in proportion to what they are applied to.
  const Eigen::SparseMatrix<double> A = affine_matrix(T);
  const Eigen::SparseMatrix<double> A_F = A * select_;
  const Eigen::SparseMatrix<double> A_F_transposed = A_F.transpose();
  const Eigen::SparseMatrix<double> squares = A_F_transposed * A_F;
  SymmetricSystem system = regularisation_;
  system.matrix += squares;
  const Eigen::MatrixXd affine = missed - A * shape, uniform = differences - laplacian_ * shape;
  const Eigen::MatrixXd uniform_squares = laplacian_.transpose() * uniform;
  const Eigen::MatrixXd b =
      A_F_transposed * affine + kLaplacian * (select_.transpose() * uniform_squares);
  if (!unknowns_.rows.empty()) shape(unknowns_.rows, Eigen::all) += CholeskyFactor(system).solve(b);
  move_to_gauge(mixed, shape);
  return shape;
}

}  // namespace morphbake
