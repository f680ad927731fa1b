#pragma once

#include <Eigen/Core>
#include <Eigen/IterativeLinearSolvers>
#include <functional>
#include <vector>

#include "morphbake/linear/symmetric_system.h"

namespace morphbake {

/// When an iteration stops.
struct StopRule {
  double tolerance = 0;      ///< on Convergence::error, in the units of X
  double amplification = 1;  ///< how often the last step fits into the error, measure_amplification
  int max_iterations = 1;    ///< sweeps, or steps
  /// Hears X and the length of the last step now and then; may be empty, may throw.
  std::function<void(const Eigen::MatrixXd& x, double step)> on_check;
};

/// Jacobi's iteration from X on: all rows at once from the old ones (the paper's solver).
///
/// @param b  #X by 3, summing to 0 over every singular block
/// @param x  #X by 3, start and result; the means of its singular blocks do not matter
/// @see      Alexa 2003, section 4.3
Convergence iterate_jacobi(const SymmetricSystem& system, const Eigen::MatrixXd& b,
                           const StopRule& stop, Eigen::MatrixXd& x);

/// As iterate_jacobi, row by row from the newest.
Convergence iterate_gauss_seidel(const SymmetricSystem& system, const Eigen::MatrixXd& b,
                                 const StopRule& stop, Eigen::MatrixXd& x);

/// Incomplete Cholesky factor of a system (Lin and Moré's, as Eigen has it).
class IncompleteFactor {
 public:
  /// @throws BakeError "linear.not-definite"
  explicit IncompleteFactor(const SymmetricSystem& system);

  /// @param r  #X by any number of columns
  Eigen::MatrixXd solve(const Eigen::MatrixXd& r) const;

 private:
  Eigen::IncompleteCholesky<double> factor_;
};

/// About X with A X = r: symmetric and positive.
using Preconditioner = std::function<Eigen::MatrixXd(const Eigen::MatrixXd& r)>;

/// Conjugate gradients with a preconditioner, the columns side by side, each with its own steps.
///
/// Means over singular blocks are projected out of the preconditioned residual: rounding would feed
/// them otherwise.
Convergence iterate_conjugate_gradients(const SymmetricSystem& system,
                                        const Preconditioner& preconditioner,
                                        const Eigen::MatrixXd& b, const StopRule& stop,
                                        Eigen::MatrixXd& x);

/// One of the iterations above with everything but these bound.
using Iteration =
    std::function<Convergence(const Eigen::MatrixXd& b, const StopRule& stop, Eigen::MatrixXd& x)>;

/// How large the error may be beside the length of a step, measured on a solution that is known:
/// the largest ratio on the way there.
///
/// @param known  #X by 3: smooth, since smooth errors die last
double measure_amplification(const SymmetricSystem& system, const Iteration& iteration,
                             const Eigen::MatrixXd& known, int max_iterations);

}  // namespace morphbake
