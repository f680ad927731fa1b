#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <variant>

#include "morphbake/cache/stage_cache.h"
#include "morphbake/linear/packed_factor.h"
#include "morphbake/linear/symmetric_system.h"

namespace morphbake {

/// Of a factor's numbers. With Single a solve reads half as much and leaves an error of 1e-7 times
/// the system's condition: right for corrections, whose residuals are formed in float64.
enum class Precision { Double, Single };

/// In which order the unknowns are eliminated. Nested dissection takes longer to find, and mostly
/// gives smaller factors; with minimum degree CHOLMOD tries it only where much is filled in.
enum class Ordering { MinimumDegree, NestedDissection };

/// The ordering with which a factor and its solves take less time.
///
/// @param solves  of three columns each
Ordering cheaper_ordering(Eigen::Index rows, double solves);

/// Lets OpenBLAS take the buffer that it needs once a process: where the system gives none, it asks
/// again and again without end. A forked process has it, too.
void reserve_blas_memory();

/// A Cholesky factor (made by CHOLMOD), made once and used for every right-hand side.
///
/// The first unknown of each singular block is set to 0 and its equation left out. That is exact
/// when the right-hand side sums to 0 over the block; the caller adds the constant that it wants.
class CholeskyFactor {
 public:
  /// @param orders  where orders of elimination are kept: finding one takes most of the time that a
  ///                large factor takes, and the factor is the same
  /// @throws BakeError "linear.out-of-memory", "linear.not-definite"
  /// @cost   K_L of a surface: O(#X^1.5) flops, 540-1000 bytes a row, half of it with Single; one
  ///         thread
  explicit CholeskyFactor(const SymmetricSystem& system, Precision precision = Precision::Double,
                          Ordering ordering = Ordering::MinimumDegree,
                          const StageCache& orders = {});

  /// May be called from several threads at once.
  ///
  /// @param b  #X by any number of columns; each column sums to 0 over every singular block
  /// @return   X with A X = b and 0 in the first row of each singular block: as b
  Eigen::MatrixXd solve(const Eigen::MatrixXd& b) const;

  /// The same of columns whose rows lie together: b <- X.
  void solve_in_place(ColumnRows& b) const;

  /// What the factor's numbers take: what a solve reads twice.
  std::size_t bytes() const;

 private:
  std::variant<PackedFactor<double>, PackedFactor<float>> packed_;
};

}  // namespace morphbake
