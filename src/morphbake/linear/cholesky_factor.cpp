#include "morphbake/linear/cholesky_factor.h"

#include <cholmod.h>
#include <fmt/core.h>
#include <sys/mman.h>

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "morphbake/cache/content_hash.h"
#include "morphbake/diagnostics/problem.h"

// From OpenBLAS, whose headers Debian keeps in a folder of the alternative that is chosen.
extern "C" void openblas_set_num_threads(int count);
// NOLINTNEXTLINE(readability-identifier-naming): Fortran's name
extern "C" void dsyrk_(const char* triangle, const char* transposed, const int* n, const int* k,
                       const double* alpha, const double* a, const int* lda, const double* beta,
                       double* c, const int* ldc);

namespace morphbake {
namespace {

[[noreturn]] void fail(const char* code, const std::string& message, const std::string& hint) {
  throw BakeError(Problem{Severity::Error, code, {}, message, hint});
}

/// CHOLMOD's parameters, status and workspace: one a thread, since each call writes to it.
struct Workspace {
  cholmod_common common{};

  explicit Workspace(Ordering ordering) {
    cholmod_start(&common);
    common.print = 0;
    common.supernodal = CHOLMOD_SUPERNODAL;
    if (ordering == Ordering::MinimumDegree) return;  // CHOLMOD's own way
    common.nmethods = 1;
    common.method[0].ordering = CHOLMOD_METIS;
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

/// Rows of the system that are factored: all but the first of each singular block.
std::vector<int> free_rows(const SymmetricSystem& system) {
  std::vector<bool> is_grounded(static_cast<std::size_t>(system.singular_block_count), false);
  std::vector<int> rows;
  for (std::size_t row = 0; row < system.singular_block.size(); ++row) {
    const int block = system.singular_block[row];
    const bool grounds = block >= 0 && !is_grounded[static_cast<std::size_t>(block)];
    if (grounds) is_grounded[static_cast<std::size_t>(block)] = true;
    if (!grounds) rows.push_back(static_cast<int>(row));
  }
  return rows;
}

/// The upper triangle of the free rows and columns.
Eigen::SparseMatrix<double> upper_of(const Eigen::SparseMatrix<double>& matrix,
                                     const std::vector<int>& free) {
  std::vector<int> number(static_cast<std::size_t>(matrix.rows()), -1);
  for (std::size_t i = 0; i < free.size(); ++i) {
    number[static_cast<std::size_t>(free[i])] = static_cast<int>(i);
  }
  std::vector<Eigen::Triplet<double>> entries;
  entries.reserve(static_cast<std::size_t>(matrix.nonZeros()) / 2 + free.size());
  for (int column = 0; column < matrix.outerSize(); ++column) {
    const int to = number[static_cast<std::size_t>(column)];
    for (Eigen::SparseMatrix<double>::InnerIterator entry(matrix, column); entry; ++entry) {
      const int from = number[static_cast<std::size_t>(entry.row())];
      if (from >= 0 && to >= 0 && from <= to) entries.emplace_back(from, to, entry.value());
    }
  }
  const auto count = static_cast<Eigen::Index>(free.size());
  Eigen::SparseMatrix<double> upper(count, count);
  upper.setFromTriplets(entries.begin(), entries.end());
  return upper;
}

template <typename Number>
std::string_view bytes_of(const Number* first, std::size_t count) {
  return {reinterpret_cast<const char*>(first), count * sizeof(Number)};
}

/// The order in which unknowns are eliminated, which depends on where the matrix has entries.
class KeptOrder {
 public:
  KeptOrder(const Eigen::SparseMatrix<double>& upper, Ordering ordering, const StageCache& cache)
      : cache_(cache), rows_(static_cast<std::size_t>(upper.rows())) {
    constexpr std::size_t kWorthKeeping = 20000;  // rows: the order of fewer is found in 5 ms
    if (!cache.is_on() || rows_ < kWorthKeeping) return;
    const auto entries = static_cast<std::size_t>(upper.nonZeros());
    key_ = content_hash(fmt::format("order {} {} {} {}", static_cast<int>(ordering), program_hash(),
                                    content_hash(bytes_of(upper.outerIndexPtr(), rows_ + 1)),
                                    content_hash(bytes_of(upper.innerIndexPtr(), entries))));
    read();
  }

  /// Row at each place, or nothing when it is to be found.
  const std::vector<int>& known() const { return known_; }

  void keep(std::span<const int> order) const {
    if (key_.empty() || !known_.empty()) return;
    try {
      cache_.keep(key_, {"{}", {std::string(bytes_of(order.data(), order.size()))}});
    } catch (const BakeError&) {
      // The next one finds it again; the bake tells of a cache that cannot be written.
    }
  }

 private:
  void read() {
    const std::optional<CacheEntry> entry = cache_.find(key_, {});
    if (!entry || entry->blobs.size() != 1) return;
    const std::string& bytes = entry->blobs[0];
    if (bytes.size() != rows_ * sizeof(int)) return;
    std::vector<int> order(rows_);
    std::memcpy(order.data(), bytes.data(), bytes.size());
    std::vector<bool> has(rows_, false);
    for (const int row : order) {
      if (row < 0 || static_cast<std::size_t>(row) >= rows_) return;
      has[static_cast<std::size_t>(row)] = true;
    }
    if (std::find(has.begin(), has.end(), false) == has.end()) known_ = std::move(order);
  }

  const StageCache& cache_;
  std::size_t rows_;
  std::string key_;
  std::vector<int> known_;
};

cholmod_factor* analysed(cholmod_sparse& matrix, Workspace& workspace,
                         const std::vector<int>& order) {
  if (order.empty()) return cholmod_analyze(&matrix, &workspace.common);
  workspace.common.nmethods = 1;
  workspace.common.method[0].ordering = CHOLMOD_GIVEN;
  std::vector<int> given = order;  // CHOLMOD takes a pointer that is not const
  return cholmod_analyze_p(&matrix, given.data(), nullptr, 0, &workspace.common);
}

/// Gives memory back to the system as it is read for the last time, so that a factor and its packed
/// form are not there as a whole at once. Whole blocks of pages; the rest is freed with the factor.
class ReadOnce {
 public:
  explicit ReadOnce(double* values) : next_(first_whole_block(values)), values_(values) {}

  void is_read(std::size_t count) {
    char* end = reinterpret_cast<char*>(values_ + count);
    const std::ptrdiff_t blocks = (end - next_) / kBlock;
    if (blocks <= 0) return;
    ::madvise(next_, static_cast<std::size_t>(blocks * kBlock), MADV_DONTNEED);
    next_ += blocks * kBlock;
  }

 private:
  static constexpr std::ptrdiff_t kBlock = 1 << 21;

  static char* first_whole_block(double* values) {
    const auto address = reinterpret_cast<std::uintptr_t>(values);
    return reinterpret_cast<char*>(values) + (kBlock - address % kBlock) % kBlock;
  }

  char* next_;
  double* values_;
};

/// The factor's values are gone afterwards.
template <class Scalar>
PackedFactor<Scalar> packed(cholmod_factor& factor, const std::vector<int>& free,
                            std::size_t row_count) {
  const auto integers = [](const void* first, std::size_t count) {
    return std::span<const int>(static_cast<const int*>(first), count);
  };
  std::vector<int> order;
  for (const int row : integers(factor.Perm, factor.n)) {
    order.push_back(free[static_cast<std::size_t>(row)]);
  }
  auto* values = static_cast<double*>(factor.x);
  ReadOnce memory(values);
  return PackedFactor<Scalar>(
      {integers(factor.super, factor.nsuper + 1), integers(factor.pi, factor.nsuper + 1),
       integers(factor.px, factor.nsuper + 1), integers(factor.s, factor.ssize), values, order,
       row_count, [&memory](std::size_t count) { memory.is_read(count); }});
}

}  // namespace

Ordering cheaper_ordering(Eigen::Index rows, double solves) {
  constexpr double kDissected = 3e7;  // rows that are solved for
  return static_cast<double>(rows) * solves < kDissected ? Ordering::MinimumDegree
                                                         : Ordering::NestedDissection;
}

void reserve_blas_memory() {
  openblas_set_num_threads(1);
  constexpr int kSize = 64;
  const std::vector<double> a(std::size_t{kSize} * kSize, 1);
  std::vector<double> c(a.size(), 0);
  const double one = 1, zero = 0;
  dsyrk_("L", "N", &kSize, &kSize, &one, a.data(), &kSize, &zero, c.data(), &kSize);
}

CholeskyFactor::CholeskyFactor(const SymmetricSystem& system, Precision precision,
                               Ordering ordering, const StageCache& orders) {
  // With several threads OpenBLAS splits sums by their number, and so would the bytes differ.
  openblas_set_num_threads(1);
  const std::vector<int> free = free_rows(system);
  if (free.empty()) return;  // nothing is unknown, which CHOLMOD does not take
  Eigen::SparseMatrix<double> upper = upper_of(system.matrix, free);
  cholmod_sparse view = upper_view(upper);
  Workspace workspace(ordering);
  KeptOrder order(upper, ordering, orders);
  cholmod_factor* made = analysed(view, workspace, order.known());
  const auto release = [&workspace](cholmod_factor* factor) {
    cholmod_free_factor(&factor, &workspace.common);
  };
  const std::unique_ptr<cholmod_factor, decltype(release)> factor(made, release);
  workspace.check(made != nullptr, "analysed");
  order.keep({static_cast<const int*>(made->Perm), free.size()});
  workspace.check(cholmod_factorize(&view, made, &workspace.common) != 0, "factorised");
  const std::size_t row_count = system.singular_block.size();
  if (precision == Precision::Single) {
    packed_ = packed<float>(*made, free, row_count);
  } else {
    packed_ = packed<double>(*made, free, row_count);
  }
}

Eigen::MatrixXd CholeskyFactor::solve(const Eigen::MatrixXd& b) const {
  return std::visit([&b](const auto& packed) { return packed.solve(b); }, packed_);
}

void CholeskyFactor::solve_in_place(ColumnRows& b) const {
  std::visit([&b](const auto& packed) { packed.solve_in_place(b); }, packed_);
}

std::size_t CholeskyFactor::bytes() const {
  return std::visit([](const auto& packed) { return packed.bytes(); }, packed_);
}

}  // namespace morphbake
