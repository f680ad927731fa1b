#pragma once

#include <Eigen/Core>
#include <Eigen/SparseCore>
#include <memory>
#include <vector>

#include "morphbake/linear/cholesky_factor.h"
#include "morphbake/linear/relax_row.h"
#include "morphbake/linear/symmetric_system.h"

namespace morphbake {

/// Multigrid by smoothed aggregation: a V-cycle, symmetric, so that conjugate gradients may be
/// preconditioned by it. For Laplacians, whose number of steps then hardly grows with their size.
/// @see  Vanek, Mandel and Brezina 1996, Algebraic multigrid by smoothed aggregation for second and
///       fourth order elliptic problems
class Multigrid {
 public:
  /// @param system  of a Laplacian; must outlive this
  /// @throws BakeError "linear.out-of-memory", "linear.not-definite"
  explicit Multigrid(const SymmetricSystem& system);

  /// About X with A X = r: one cycle from 0.
  ///
  /// @param r  #X by 3; each column sums to 0 over every singular block
  ThreeColumns cycle(const ThreeColumns& r) const { return cycle(0, r); }

  /// Beside the system's own matrix.
  std::size_t bytes() const;

 private:
  struct Level {
    Eigen::SparseMatrix<double> prolongation;  ///< from the next, coarser level
    SymmetricSystem coarse;                    ///< the next level's
  };

  static std::vector<std::unique_ptr<const Level>> coarser_levels(const SymmetricSystem& finest);
  const SymmetricSystem& system_of(std::size_t level) const;
  ThreeColumns cycle(std::size_t level, const ThreeColumns& r) const;

  const SymmetricSystem& finest_;
  std::vector<std::unique_ptr<const Level>> levels_;
  CholeskyFactor coarsest_;
};

}  // namespace morphbake
