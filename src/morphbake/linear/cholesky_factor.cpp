#include "morphbake/linear/cholesky_factor.h"

#include <cholmod.h>
#include <fmt/core.h>

#include <utility>

#include "morphbake/diagnostics/problem.h"

// From OpenBLAS, whose headers Debian keeps in a folder of the alternative that is chosen.
extern "C" void openblas_set_num_threads(int count);

namespace morphbake {
namespace {

[[noreturn]] void fail(const char* code, const std::string& message, const std::string& hint) {
  throw BakeError(Problem{Severity::Error, code, {}, message, hint});
}

/// CHOLMOD's parameters, status and workspace: one a thread, since each call writes to it.
struct Workspace {
  cholmod_common common{};

  Workspace() {
    cholmod_start(&common);
    common.print = 0;
    common.supernodal = CHOLMOD_SUPERNODAL;
  }

  Workspace(const Workspace&) = delete;
  Workspace& operator=(const Workspace&) = delete;

  ~Workspace() { cholmod_finish(&common); }

  void check(bool succeeded, const char* action) const {
    if (succeeded && common.status >= CHOLMOD_OK && common.status != CHOLMOD_NOT_POSDEF) return;
    if (common.status == CHOLMOD_OUT_OF_MEMORY || common.status == CHOLMOD_TOO_LARGE) {
      fail("linear.out-of-memory", "not enough memory to factorise",
           "set the option /solve/solver to pcg, which needs no factor");
    }
    fail("linear.not-definite",
         fmt::format("the system cannot be {} (status {})", action, common.status), "");
  }
};

cholmod_dense dense_view(Eigen::MatrixXd& columns) {
  cholmod_dense view{};
  view.nrow = view.d = static_cast<std::size_t>(columns.rows());
  view.ncol = static_cast<std::size_t>(columns.cols());
  view.nzmax = static_cast<std::size_t>(columns.size());
  view.x = columns.data();
  view.xtype = CHOLMOD_REAL;
  view.dtype = CHOLMOD_DOUBLE;
  return view;
}

/// View of a matrix of which only the upper triangle is stored.
cholmod_sparse upper_view(Eigen::SparseMatrix<double>& upper) {
  cholmod_sparse view{};
  view.nrow = view.ncol = static_cast<std::size_t>(upper.rows());
  view.nzmax = static_cast<std::size_t>(upper.nonZeros());
  view.p = upper.outerIndexPtr();
  view.i = upper.innerIndexPtr();
  view.x = upper.valuePtr();
  view.stype = 1;
  view.itype = CHOLMOD_INT;
  view.xtype = CHOLMOD_REAL;
  view.dtype = CHOLMOD_DOUBLE;
  view.sorted = view.packed = 1;
  return view;
}

}  // namespace

struct CholeskyFactor::Cholmod {
  Workspace workspace;
  cholmod_factor* factor = nullptr;
  std::vector<int> free_row;  ///< row of the system -> row of the factored matrix, or -1
  int free_count = 0;

  Cholmod() = default;
  Cholmod(const Cholmod&) = delete;
  Cholmod& operator=(const Cholmod&) = delete;

  ~Cholmod() {
    if (factor != nullptr) cholmod_free_factor(&factor, &workspace.common);
  }

  void ground_blocks(const SymmetricSystem& system) {
    std::vector<bool> is_grounded(static_cast<std::size_t>(system.singular_block_count), false);
    for (const int block : system.singular_block) {
      const bool grounds = block >= 0 && !is_grounded[static_cast<std::size_t>(block)];
      free_row.push_back(grounds ? -1 : free_count++);
      if (grounds) is_grounded[static_cast<std::size_t>(block)] = true;
    }
  }

  Eigen::SparseMatrix<double> upper_of(const Eigen::SparseMatrix<double>& matrix) const {
    std::vector<Eigen::Triplet<double>> entries;
    entries.reserve(static_cast<std::size_t>(matrix.nonZeros()) / 2 + free_row.size());
    for (int column = 0; column < matrix.outerSize(); ++column) {
      const int to = free_row[static_cast<std::size_t>(column)];
      for (Eigen::SparseMatrix<double>::InnerIterator entry(matrix, column); entry; ++entry) {
        const int from = free_row[static_cast<std::size_t>(entry.row())];
        if (from >= 0 && to >= 0 && from <= to) entries.emplace_back(from, to, entry.value());
      }
    }
    Eigen::SparseMatrix<double> upper(free_count, free_count);
    upper.setFromTriplets(entries.begin(), entries.end());
    return upper;
  }
};

CholeskyFactor::CholeskyFactor(CholeskyFactor&&) noexcept = default;
CholeskyFactor& CholeskyFactor::operator=(CholeskyFactor&&) noexcept = default;
CholeskyFactor::~CholeskyFactor() = default;

CholeskyFactor::CholeskyFactor(const SymmetricSystem& system)
    : cholmod_(std::make_unique<Cholmod>()) {
  // With several threads OpenBLAS splits sums by their number, and so would the bytes differ.
  openblas_set_num_threads(1);
  cholmod_->ground_blocks(system);
  if (cholmod_->free_count == 0) return;  // nothing is unknown, which CHOLMOD does not take
  Eigen::SparseMatrix<double> upper = cholmod_->upper_of(system.matrix);
  cholmod_sparse view = upper_view(upper);
  cholmod_common& common = cholmod_->workspace.common;
  cholmod_->factor = cholmod_analyze(&view, &common);
  cholmod_->workspace.check(cholmod_->factor != nullptr, "analysed");
  const bool succeeded = cholmod_factorize(&view, cholmod_->factor, &common) != 0;
  cholmod_->workspace.check(succeeded, "factorised");
}

Eigen::MatrixXd CholeskyFactor::solve(const Eigen::MatrixXd& b) const {
  const std::vector<int>& free_row = cholmod_->free_row;
  if (cholmod_->free_count == 0) return Eigen::MatrixXd::Zero(b.rows(), b.cols());
  Eigen::MatrixXd free_b(cholmod_->free_count, b.cols());
  for (std::size_t row = 0; row < free_row.size(); ++row) {
    if (free_row[row] >= 0) free_b.row(free_row[row]) = b.row(static_cast<Eigen::Index>(row));
  }
  Workspace workspace;
  cholmod_dense view = dense_view(free_b);
  cholmod_dense* solution = cholmod_solve(CHOLMOD_A, cholmod_->factor, &view, &workspace.common);
  workspace.check(solution != nullptr, "solved");
  const Eigen::Map<const Eigen::MatrixXd> free_x(static_cast<const double*>(solution->x),
                                                 free_b.rows(), free_b.cols());
  Eigen::MatrixXd x = Eigen::MatrixXd::Zero(b.rows(), b.cols());
  for (std::size_t row = 0; row < free_row.size(); ++row) {
    if (free_row[row] >= 0) x.row(static_cast<Eigen::Index>(row)) = free_x.row(free_row[row]);
  }
  cholmod_free_dense(&solution, &workspace.common);
  return x;
}

std::size_t CholeskyFactor::bytes() const {
  if (cholmod_->factor == nullptr) return 0;
  return cholmod_->factor->xsize * sizeof(double) + cholmod_->factor->ssize * sizeof(int);
}

}  // namespace morphbake
