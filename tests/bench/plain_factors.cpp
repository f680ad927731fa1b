#include "bench/plain_factors.h"

#include <cholmod.h>

namespace morphbake::bench {

Eigen::SparseMatrix<double> grounded(const Eigen::SparseMatrix<double>& matrix) {
  return matrix.bottomRightCorner(matrix.rows() - 1, matrix.cols() - 1);
}

PlainCholmod::PlainCholmod(const Eigen::SparseMatrix<double>& matrix)
    : common_(new cholmod_common) {
  cholmod_start(common_);
  common_->supernodal = CHOLMOD_SUPERNODAL;
  Eigen::SparseMatrix<double> upper = matrix.triangularView<Eigen::Upper>();
  cholmod_sparse view{};
  view.nrow = view.ncol = static_cast<std::size_t>(upper.rows());
  view.nzmax = static_cast<std::size_t>(upper.nonZeros());
  view.p = upper.outerIndexPtr();
  view.i = upper.innerIndexPtr();
  view.x = upper.valuePtr();
  view.stype = 1;
  view.itype = CHOLMOD_INT;
  view.xtype = CHOLMOD_REAL;
  view.sorted = view.packed = 1;
  factor_ = cholmod_analyze(&view, common_);
  cholmod_factorize(&view, factor_, common_);
}

PlainCholmod::~PlainCholmod() {
  cholmod_free_factor(&factor_, common_);
  cholmod_finish(common_);
  delete common_;
}

void PlainCholmod::solve(Eigen::MatrixXd& b) const {
  cholmod_dense view{};
  view.nrow = view.d = static_cast<std::size_t>(b.rows());
  view.ncol = static_cast<std::size_t>(b.cols());
  view.nzmax = static_cast<std::size_t>(b.size());
  view.x = b.data();
  view.xtype = CHOLMOD_REAL;
  cholmod_dense* x = cholmod_solve(CHOLMOD_A, factor_, &view, common_);
  b = Eigen::Map<const Eigen::MatrixXd>(static_cast<const double*>(x->x), b.rows(), b.cols());
  cholmod_free_dense(&x, common_);
}

}  // namespace morphbake::bench
