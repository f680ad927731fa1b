#include "morphbake/linear/iterate.h"

#include <algorithm>
#include <cmath>

#include "morphbake/diagnostics/problem.h"
#include "morphbake/linear/relax_row.h"

// Why the stop is not on the residual: error / residual differs by a thousand between methods (25
// for Gauss-Seidel, 0.03 for multigrid, measured at 104k vertices), so a residual says little about
// how far a vertex still is from its place. Nor does extrapolating from how the last steps shrink:
// it was tried, and was wrong by 20 for conjugate gradients, which stand still before they find a
// smooth error, and by 2 for relaxation. So the ratio of error to step is measured once for each
// system.

namespace morphbake {
namespace {

constexpr int kSweepsPerCheck = 32;  // single sweeps move so little that rounding would show

double largest_row(const Eigen::MatrixXd& rows) {
  return rows.rows() == 0 ? 0 : std::sqrt(rows.rowwise().squaredNorm().maxCoeff());
}

double relative_residual(const SymmetricSystem& system, const Eigen::MatrixXd& b,
                         const Eigen::MatrixXd& x) {
  const double residual = (b - system.matrix * x).norm();
  const double scale = b.norm();
  return scale > 0 ? residual / scale : residual;
}

void check_step(const StopRule& stop, const Eigen::MatrixXd& x, double step,
                Convergence& convergence) {
  convergence.error = stop.amplification * step;
  convergence.reached = convergence.error <= stop.tolerance;
  if (stop.on_check) stop.on_check(x, step);
}

/// Sweeps for stationary iterations; `sweep` turns the old rows into the new.
template <typename Sweep>
Convergence run_sweeps(const SymmetricSystem& system, const Eigen::MatrixXd& b,
                       const StopRule& stop, Eigen::MatrixXd& x, const Sweep& sweep) {
  ThreeColumns rows = x;  // side by side in memory: a row's three coordinates are one cache line
  const ThreeColumns goal = b;
  Convergence convergence;
  while (!convergence.reached && convergence.iterations < stop.max_iterations) {
    const int count = std::min(kSweepsPerCheck, stop.max_iterations - convergence.iterations);
    for (int i = 0; i < count; ++i) sweep(goal, rows);
    convergence.iterations += count;
    Eigen::MatrixXd move = rows - x;
    remove_block_means(system, move);  // a constant that drifts changes no shape
    x = rows;
    check_step(stop, x, largest_row(move), convergence);
  }
  convergence.residual = relative_residual(system, b, x);
  return convergence;
}

}  // namespace

Convergence iterate_jacobi(const SymmetricSystem& system, const Eigen::MatrixXd& b,
                           const StopRule& stop, Eigen::MatrixXd& x) {
  ThreeColumns next(x.rows(), 3);
  return run_sweeps(system, b, stop, x, [&](const ThreeColumns& goal, ThreeColumns& rows) {
    for (Eigen::Index row = 0; row < rows.rows(); ++row) {
      next.row(row) = relaxed_row(system.matrix, goal, rows, row);
    }
    rows.swap(next);
  });
}

Convergence iterate_gauss_seidel(const SymmetricSystem& system, const Eigen::MatrixXd& b,
                                 const StopRule& stop, Eigen::MatrixXd& x) {
  return run_sweeps(system, b, stop, x, [&](const ThreeColumns& goal, ThreeColumns& rows) {
    for (Eigen::Index row = 0; row < rows.rows(); ++row) {
      rows.row(row) = relaxed_row(system.matrix, goal, rows, row);
    }
  });
}

IncompleteFactor::IncompleteFactor(const SymmetricSystem& system) {
  factor_.compute(system.matrix);
  if (factor_.info() != Eigen::Success) {
    throw BakeError(Problem{Severity::Error,
                            "linear.not-definite",
                            {},
                            "the system has no incomplete Cholesky factor",
                            "set the option /solve/solver to direct"});
  }
}

Eigen::MatrixXd IncompleteFactor::solve(const Eigen::MatrixXd& r) const {
  Eigen::MatrixXd z(r.rows(), r.cols());
  for (Eigen::Index c = 0; c < r.cols(); ++c) {
    z.col(c) = factor_.solve(Eigen::VectorXd(r.col(c)));
  }
  return z;
}

Convergence iterate_conjugate_gradients(const SymmetricSystem& system,
                                        const Preconditioner& preconditioner,
                                        const Eigen::MatrixXd& b, const StopRule& stop,
                                        Eigen::MatrixXd& x) {
  const auto precondition = [&](const Eigen::MatrixXd& r) {
    Eigen::MatrixXd z = preconditioner(r);
    remove_block_means(system, z);
    return z;
  };
  const auto dots = [](const Eigen::MatrixXd& left, const Eigen::MatrixXd& right) {
    return left.cwiseProduct(right).colwise().sum().transpose().array().eval();
  };
  Eigen::MatrixXd r = b - system.matrix * x;
  Eigen::MatrixXd z = precondition(r);
  Eigen::MatrixXd p = z;
  Eigen::ArrayXd rz = dots(r, z);
  Convergence convergence;
  check_step(stop, x, largest_row(z), convergence);
  while (!convergence.reached && convergence.iterations < stop.max_iterations) {
    const Eigen::MatrixXd q = system.matrix * p;
    const Eigen::ArrayXd curvature = dots(p, q);
    const Eigen::ArrayXd along = (curvature > 0).select(rz / curvature, 0.0);
    x += p * along.matrix().asDiagonal();
    r -= q * along.matrix().asDiagonal();
    z = precondition(r);
    const Eigen::ArrayXd next = dots(r, z);
    const Eigen::ArrayXd kept = (rz > 0).select(next / rz, 0.0);
    p = z + p * kept.matrix().asDiagonal();
    rz = next;
    ++convergence.iterations;
    check_step(stop, x, largest_row(z), convergence);
  }
  convergence.residual = relative_residual(system, b, x);
  return convergence;
}

double measure_amplification(const SymmetricSystem& system, const Iteration& iteration,
                             const Eigen::MatrixXd& known, int max_iterations) {
  constexpr double kFarEnough = 1e-4;  // by then only the slowest errors are left
  Eigen::MatrixXd centred = known;
  remove_block_means(system, centred);
  const double start = largest_row(centred);
  double amplification = 1, error = start;
  StopRule stop;
  stop.max_iterations = max_iterations;
  stop.tolerance = 0;

  struct Done {};

  stop.on_check = [&](const Eigen::MatrixXd& x, double step) {
    Eigen::MatrixXd missing = x - known;
    remove_block_means(system, missing);
    error = largest_row(missing);
    if (step > 0) amplification = std::max(amplification, error / step);
    if (error <= kFarEnough * start) throw Done();
  };
  Eigen::MatrixXd x = Eigen::MatrixXd::Zero(known.rows(), known.cols());
  try {
    iteration(system.matrix * known, stop, x);
  } catch (const Done&) {
  }
  return amplification;
}

}  // namespace morphbake
