#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <variant>
#include <vector>

#include "morphbake/diagnostics/observer.h"
#include "morphbake/linear/cholesky_factor.h"
#include "morphbake/linear/iterate.h"
#include "morphbake/linear/multigrid.h"
#include "morphbake/solve/displacement_system.h"

namespace morphbake {

/// Whether a factor of the system's equations stays below the memory limit.
bool allows_factor(const DisplacementSystem& system, const SolveOptions& options);

/// Which solver, and why.
struct SolverChoice {
  Solver solver = Solver::Direct;  ///< never Auto
  std::string reason;
};

/// @throws BakeError "options.cannot-hold" when Jacobi or Gauss-Seidel shall solve a held system
SolverChoice choose_solver(const DisplacementSystem& system, const SolveOptions& options);

/// Solves one displacement system for any number of goals.
///
/// `direct` and `warm` correct x by a Cholesky factor until the estimated error is within the
/// tolerance: a correction leaves a known share of the error it finds. The iterations go on from x
/// until their steps are so small that the error must be. Both ratios are measured once, on a
/// solution that is known: the surface itself.
class SurfaceSolver {
 public:
  /// @param system  must outlive the solver
  /// @param single  a float32 factor of the system's equations, where somebody has one already
  SurfaceSolver(const DisplacementSystem& system, const SolveOptions& options,
                const Observer& observer, std::shared_ptr<const CholeskyFactor> single = nullptr);

  const SolverChoice& choice() const { return choice_; }

  const DisplacementSystem& system() const { return system_; }

  std::size_t factor_bytes() const;

  /// Whether a solve is cheaper from a start close by.
  bool is_iterative() const { return !std::holds_alternative<Factor>(method_); }

  /// Solves for all goals at once: those with a factor share each pass over it.
  ///
  /// May be called from several threads with different goals.
  /// @param starts  one a goal: unknowns by 3
  /// @param x       one a goal: the solutions
  /// @throws BakeError "solve.no-convergence"; Cancelled
  std::vector<Convergence> solve(const std::vector<Goal>& goals,
                                 std::vector<Eigen::MatrixXd>& x) const;

 private:
  struct NoFactor {};

  using Factor = std::shared_ptr<const CholeskyFactor>;

  std::vector<Convergence> solve_by_factor(const std::vector<Goal>& goals,
                                           std::vector<Eigen::MatrixXd>& x) const;
  Preconditioner preconditioner() const;
  Iteration iteration() const;
  void calibrate();

  const DisplacementSystem& system_;
  SolveOptions options_;
  const Observer& observer_;
  SolverChoice choice_;
  std::variant<NoFactor, Factor, IncompleteFactor, Multigrid> method_;
  double contraction_ = 0;    ///< share of the error that a correction by the factor leaves
  double amplification_ = 1;  ///< error beside the length of an iteration's step
};

}  // namespace morphbake
