#include "morphbake/linear/block_lanczos.h"

#include <Eigen/Eigenvalues>
#include <Eigen/QR>
#include <algorithm>
#include <cassert>

namespace morphbake {
namespace {

constexpr int kBlocksPerCheck = 3;

/// The subspace as it grows: A V = V T + (next block) B at its last columns.
struct Krylov {
  Eigen::MatrixXd V;  ///< #X by room + a block
  Eigen::MatrixXd T;
  Eigen::MatrixXd B;      ///< of the last block: upper triangle
  Eigen::Index size = 0;  ///< columns of V that T covers
};

/// Orthonormal columns Q with columns = Q R; returns R.
Eigen::MatrixXd factor_columns(Eigen::Ref<Eigen::MatrixXd> columns) {
  const Eigen::Index count = columns.cols();
  const Eigen::HouseholderQR<Eigen::MatrixXd> qr(columns);
  columns = qr.householderQ() * Eigen::MatrixXd::Identity(columns.rows(), count);
  return qr.matrixQR().topRows(count).triangularView<Eigen::Upper>();
}

/// Takes the part in V away, and adds it to `parts`.
template <typename Basis>
void remove_parts(const Basis& V, Eigen::MatrixXd& columns, Eigen::MatrixXd& parts) {
  const Eigen::MatrixXd found = V.transpose() * columns;
  columns.noalias() -= V * found;
  parts += found;
}

void grow(const BlockOperator& A, Eigen::Index width, Krylov& space) {
  const Eigen::Index size = space.size + width;
  const auto V = space.V.leftCols(size);
  Eigen::MatrixXd next = A(space.V.middleCols(space.size, width));
  Eigen::MatrixXd parts = Eigen::MatrixXd::Zero(size, width);
  remove_parts(V, next, parts);
  remove_parts(V, next, parts);
  space.T.block(0, space.size, size, width) = parts;
  space.T.block(space.size, 0, width, size) = parts.transpose();
  const Eigen::MatrixXd first = factor_columns(next);
  // Where the space is complete, what is left is rounding, and no longer orthogonal when it is
  // brought to length 1.
  Eigen::MatrixXd rest = Eigen::MatrixXd::Zero(size, width);
  remove_parts(V, next, rest);
  space.B = factor_columns(next) * first;
  space.V.middleCols(size, width) = next;
  space.size = size;
}

RitzPairs extract(const Krylov& space, Eigen::Index wanted, double tolerance) {
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(
      space.T.topLeftCorner(space.size, space.size));
  const Eigen::Index count = std::min(wanted, space.size);
  const Eigen::MatrixXd amplitudes = solver.eigenvectors().rightCols(count).rowwise().reverse();
  RitzPairs pairs;
  pairs.values = solver.eigenvalues().tail(count).reverse();
  pairs.vectors = amplitudes;
  pairs.residuals = (space.B * amplitudes.bottomRows(space.B.cols())).colwise().norm().transpose();
  while (pairs.converged < count &&
         pairs.residuals(pairs.converged) <= tolerance * std::abs(pairs.values(pairs.converged))) {
    ++pairs.converged;
  }
  return pairs;
}

}  // namespace

RitzPairs block_lanczos(const BlockOperator& A, const Eigen::MatrixXd& start, Eigen::Index wanted,
                        const BlockLanczosOptions& options) {
  const Eigen::Index width = start.cols();
  assert(options.room >= width && wanted > 0);
  Krylov space;
  space.V.resize(start.rows(), options.room + width);
  space.T = Eigen::MatrixXd::Zero(options.room, options.room);
  space.V.leftCols(width) = start;
  factor_columns(space.V.leftCols(width));
  RitzPairs pairs;
  int blocks = 0;
  while (space.size + width <= options.room && pairs.converged < wanted) {
    grow(A, width, space);
    const bool is_last = space.size + width > options.room;
    if (!is_last && (space.size < wanted || ++blocks % kBlocksPerCheck != 0)) continue;
    pairs = extract(space, wanted, options.tolerance);
  }
  pairs.vectors = space.V.leftCols(space.size) * pairs.vectors;
  return pairs;
}

}  // namespace morphbake
