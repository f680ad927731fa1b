#include "morphbake/linear/laplacian_factor.h"

#include <cholmod.h>
#include <fmt/core.h>

#include <utility>

#include "morphbake/diagnostics/problem.h"

// From OpenBLAS, whose headers Debian keeps in a folder of the alternative that is chosen.
extern "C" void openblas_set_num_threads(int count);

namespace morphbake {
namespace {

[[noreturn]] void fail(const char* code, const std::string& message) {
  throw BakeError(Problem{Severity::Error, code, {}, message, ""});
}

}  // namespace

struct LaplacianFactor::Cholmod {
  cholmod_common common{};
  cholmod_factor* factor = nullptr;
  std::vector<int> free_row;  ///< vertex -> row of the factored matrix, -1 when grounded
  int free_count = 0;

  Cholmod() {
    // One thread: with several, OpenBLAS splits sums by their number, and so would the bytes
    // differ.
    openblas_set_num_threads(1);
    cholmod_start(&common);
    common.print = 0;
    common.supernodal = CHOLMOD_SUPERNODAL;
  }

  Cholmod(const Cholmod&) = delete;
  Cholmod& operator=(const Cholmod&) = delete;

  ~Cholmod() {
    cholmod_free_factor(&factor, &common);
    cholmod_finish(&common);
  }

  void check(bool succeeded, const char* action) const {
    if (succeeded && common.status >= CHOLMOD_OK && common.status != CHOLMOD_NOT_POSDEF) return;
    if (common.status == CHOLMOD_OUT_OF_MEMORY)
      fail("linear.out-of-memory", "not enough memory to factorise");
    fail("linear.not-definite",
         fmt::format("the Laplacian cannot be {} (status {})", action, common.status));
  }
};

LaplacianFactor::LaplacianFactor(LaplacianFactor&&) noexcept = default;
LaplacianFactor& LaplacianFactor::operator=(LaplacianFactor&&) noexcept = default;
LaplacianFactor::~LaplacianFactor() = default;

LaplacianFactor::LaplacianFactor(const Eigen::SparseMatrix<double>& K_L,
                                 const Components& components)
    : cholmod_(std::make_unique<Cholmod>()) {
  std::vector<bool> is_grounded(static_cast<std::size_t>(components.count), false);
  cholmod_->free_row.resize(components.label.size());
  for (std::size_t v = 0; v < components.label.size(); ++v) {
    auto grounded = is_grounded[static_cast<std::size_t>(components.label[v])];
    cholmod_->free_row[v] = grounded ? cholmod_->free_count++ : -1;
    grounded = true;
  }
  std::vector<Eigen::Triplet<double>> upper;
  for (int column = 0; column < K_L.outerSize(); ++column) {
    const int to = cholmod_->free_row[static_cast<std::size_t>(column)];
    for (Eigen::SparseMatrix<double>::InnerIterator entry(K_L, column); entry; ++entry) {
      const int from = cholmod_->free_row[static_cast<std::size_t>(entry.row())];
      if (from >= 0 && to >= 0 && from <= to) upper.emplace_back(from, to, entry.value());
    }
  }
  Eigen::SparseMatrix<double> grounded_matrix(cholmod_->free_count, cholmod_->free_count);
  grounded_matrix.setFromTriplets(upper.begin(), upper.end());

  cholmod_sparse view{};
  view.nrow = view.ncol = static_cast<std::size_t>(cholmod_->free_count);
  view.nzmax = static_cast<std::size_t>(grounded_matrix.nonZeros());
  view.p = grounded_matrix.outerIndexPtr();
  view.i = grounded_matrix.innerIndexPtr();
  view.x = grounded_matrix.valuePtr();
  view.stype = 1;
  view.itype = CHOLMOD_INT;
  view.xtype = CHOLMOD_REAL;
  view.dtype = CHOLMOD_DOUBLE;
  view.sorted = view.packed = 1;
  cholmod_->factor = cholmod_analyze(&view, &cholmod_->common);
  cholmod_->check(cholmod_->factor != nullptr, "analysed");
  cholmod_->check(cholmod_factorize(&view, cholmod_->factor, &cholmod_->common) != 0, "factorised");
}

Eigen::MatrixXd LaplacianFactor::solve(const Eigen::MatrixXd& b) const {
  const std::vector<int>& free_row = cholmod_->free_row;
  Eigen::MatrixXd free_b(cholmod_->free_count, b.cols());
  for (std::size_t v = 0; v < free_row.size(); ++v) {
    if (free_row[v] >= 0) free_b.row(free_row[v]) = b.row(static_cast<Eigen::Index>(v));
  }
  cholmod_dense view{};
  view.nrow = view.d = static_cast<std::size_t>(free_b.rows());
  view.ncol = static_cast<std::size_t>(free_b.cols());
  view.nzmax = static_cast<std::size_t>(free_b.size());
  view.x = free_b.data();
  view.xtype = CHOLMOD_REAL;
  view.dtype = CHOLMOD_DOUBLE;
  cholmod_dense* solution = cholmod_solve(CHOLMOD_A, cholmod_->factor, &view, &cholmod_->common);
  cholmod_->check(solution != nullptr, "solved");
  const Eigen::Map<const Eigen::MatrixXd> free_x(static_cast<const double*>(solution->x),
                                                 free_b.rows(), free_b.cols());
  Eigen::MatrixXd x = Eigen::MatrixXd::Zero(b.rows(), b.cols());
  for (std::size_t v = 0; v < free_row.size(); ++v) {
    if (free_row[v] >= 0) x.row(static_cast<Eigen::Index>(v)) = free_x.row(free_row[v]);
  }
  cholmod_free_dense(&solution, &cholmod_->common);
  return x;
}

}  // namespace morphbake
