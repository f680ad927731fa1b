#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <memory>

#include "morphbake/linear/symmetric_system.h"

namespace morphbake {

/// A supernodal Cholesky factor (CHOLMOD), made once and used for every right-hand side.
///
/// The first unknown of each singular block is set to 0 and its equation left out. That is exact
/// when the right-hand side sums to 0 over the block; the caller adds the constant that it wants.
class CholeskyFactor {
 public:
  /// @throws BakeError "linear.out-of-memory", "linear.not-definite"
  /// @cost   K_L of a surface: O(#X^1.5) flops, 350-570 bytes a row; one thread
  explicit CholeskyFactor(const SymmetricSystem& system);
  CholeskyFactor(CholeskyFactor&&) noexcept;
  CholeskyFactor& operator=(CholeskyFactor&&) noexcept;
  ~CholeskyFactor();

  /// May be called from several threads at once.
  ///
  /// @param b  #X by any number of columns; each column sums to 0 over every singular block
  /// @return   X with A X = b and 0 in the first row of each singular block: as b
  Eigen::MatrixXd solve(const Eigen::MatrixXd& b) const;

  /// What the factor's numbers take: what a solve reads twice.
  std::size_t bytes() const;

 private:
  struct Cholmod;
  std::unique_ptr<Cholmod> cholmod_;
};

}  // namespace morphbake
