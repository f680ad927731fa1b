#include "morphbake/solve/surface_solver.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "morphbake/diagnostics/problem.h"

namespace morphbake {
namespace {

/// Bytes of a float64 factor a row, measured at 100k vertices (pipeline/bench): K_L and L^T L.
constexpr double kHarmonicBytes = 850;
constexpr double kHeldBytes = 1700;

constexpr int kCorrectionLimit = 8;
constexpr double kSmallestContraction = 1e-15;

/// One solution is known, others may keep more of their error: twenty times as much was seen with
/// half of 100k vertices held (tests/property/hold_long_test.cpp).
constexpr double kContractionMargin = 100;

/// Errors of other right-hand sides may be slower ones than the surface's own: up to twice was seen
/// on three meshes (tests/property/solvers_long_test.cpp).
constexpr double kAmplificationMargin = 3;

double largest_row(const Eigen::MatrixXd& rows) {
  return rows.rows() == 0 ? 0 : std::sqrt(rows.rowwise().squaredNorm().maxCoeff());
}

/// Adds three of the columns, row by row.
///
/// @return  the longest row that was added
double add_columns(const ColumnRows& columns, Eigen::Index first, Eigen::MatrixXd& x) {
  double longest = 0;
  for (Eigen::Index row = 0; row < x.rows(); ++row) {
    const Eigen::RowVector3d added = columns.block<1, 3>(row, first);
    x.row(row) += added;
    longest = std::max(longest, added.squaredNorm());
  }
  return std::sqrt(longest);
}

double expected_factor_bytes(const DisplacementSystem& system) {
  const auto rows = static_cast<double>(system.equations().matrix.rows());
  return rows * (system.holds() ? kHeldBytes : kHarmonicBytes);
}

Problem no_convergence(const SolverChoice& choice, const Convergence& reached,
                       const SolveOptions& options, double diagonal) {
  return {Severity::Error,
          "solve.no-convergence",
          {},
          fmt::format("{} stopped after {} iterations at an estimated error of {:.1e} of the "
                      "diagonal; the tolerance is {:.1e}",
                      name_of(choice.solver), reached.iterations, reached.error / diagonal,
                      options.tolerance),
          "set /solve/solver to direct, or raise /solve/max_iterations or /solve/tolerance"};
}

}  // namespace

bool allows_factor(const DisplacementSystem& system, const SolveOptions& options) {
  return expected_factor_bytes(system) <= 1e9 * options.memory_limit;
}

SolverChoice choose_solver(const DisplacementSystem& system, const SolveOptions& options) {
  const bool relaxes = options.solver == Solver::Jacobi || options.solver == Solver::GaussSeidel;
  if (relaxes && system.holds()) {
    throw BakeError(Problem{
        Severity::Error,
        "options.cannot-hold",
        {},
        fmt::format("{} cannot solve a system with held vertices: it squares the Laplacian, and "
                    "relaxation would need millions of sweeps",
                    name_of(options.solver)),
        "write \"hold\": \"none\" in the recipe, or choose another /solve/solver"});
  }
  if (options.solver != Solver::Auto) return {options.solver, "as the options say"};
  const double gigabytes = expected_factor_bytes(system) / 1e9;
  if (!allows_factor(system, options)) {
    return {Solver::ConjugateGradients,
            fmt::format("a factor would take about {:.2g} GB, the limit is {:.2g}", gigabytes,
                        options.memory_limit)};
  }
  if (options.every_frame) {
    return {Solver::Warm,
            fmt::format("every frame is solved; a factor takes about {:.2f} GB", gigabytes)};
  }
  return {Solver::Direct,
          fmt::format("the timeline separates into few shapes; a factor takes about {:.2f} GB",
                      gigabytes)};
}

SurfaceSolver::SurfaceSolver(const DisplacementSystem& system, const SolveOptions& options,
                             const Observer& observer, std::shared_ptr<const CholeskyFactor> single)
    : system_(system),
      options_(options),
      observer_(observer),
      choice_(choose_solver(system, options)) {
  if (choice_.solver == Solver::Direct || choice_.solver == Solver::Warm) {
    // Corrections of L^T L by a float32 factor barely contract.
    const bool is_single = choice_.solver == Solver::Warm && !system.holds();
    if (is_single && single) {
      method_ = std::move(single);
    } else {
      method_ = std::make_shared<const CholeskyFactor>(
          system.equations(), is_single ? Precision::Single : Precision::Double,
          cheaper_ordering(system.equations().matrix.rows(), options.frames), options.orders);
    }
  } else if (choice_.solver == Solver::ConjugateGradients) {
    if (system.holds()) {
      method_.emplace<IncompleteFactor>(system.equations());  // L^T L is no Laplacian
    } else {
      method_.emplace<Multigrid>(system.equations());
    }
  }
  calibrate();
}

std::size_t SurfaceSolver::factor_bytes() const {
  const auto* factor = std::get_if<Factor>(&method_);
  return factor == nullptr ? 0 : (*factor)->bytes();
}

/// Solves for the surface itself, which is as smooth as errors that die last.
void SurfaceSolver::calibrate() {
  const SymmetricSystem& equations = system_.equations();
  if (equations.matrix.rows() == 0) return;
  const Eigen::MatrixXd known = system_.rest();
  if (is_iterative()) {
    amplification_ = kAmplificationMargin *
                     measure_amplification(equations, iteration(), known, options_.max_iterations);
    return;
  }
  Eigen::MatrixXd error = std::get<Factor>(method_)->solve(equations.matrix * known) - known;
  remove_block_means(equations, error);
  contraction_ =
      kContractionMargin * std::max(kSmallestContraction, largest_row(error) / system_.diagonal());
}

std::vector<Convergence> SurfaceSolver::solve(const std::vector<Goal>& goals,
                                              std::vector<Eigen::MatrixXd>& x) const {
  std::vector<Convergence> reached;
  if (is_iterative()) {
    StopRule stop;
    stop.tolerance = options_.tolerance * system_.diagonal();
    stop.amplification = amplification_;
    stop.max_iterations = options_.max_iterations;
    stop.on_check = [this](const Eigen::MatrixXd&, double) { stop_if_cancelled(observer_); };
    for (std::size_t i = 0; i < goals.size(); ++i) {
      const Eigen::MatrixXd b = system_.right_hand_side(goals[i]);
      reached.push_back(iteration()(b, stop, x[i]));
    }
  } else {
    reached = solve_by_factor(goals, x);
  }
  for (const Convergence& each : reached) {
    if (each.reached) continue;
    throw BakeError(no_convergence(choice_, each, options_, system_.diagonal()));
  }
  return reached;
}

std::vector<Convergence> SurfaceSolver::solve_by_factor(const std::vector<Goal>& goals,
                                                        std::vector<Eigen::MatrixXd>& x) const {
  const CholeskyFactor& factor = *std::get<Factor>(method_);
  const double tolerance = options_.tolerance * system_.diagonal();
  const Eigen::Index rows = system_.equations().matrix.rows();
  std::vector<Convergence> reached(goals.size());
  std::vector<std::size_t> open(rows > 0 ? goals.size() : 0);  // each ends by itself
  std::iota(open.begin(), open.end(), std::size_t{0});
  for (int pass = 1; pass <= kCorrectionLimit && !open.empty(); ++pass) {
    ColumnRows corrections(rows, 3 * static_cast<Eigen::Index>(open.size()));
    for (std::size_t k = 0; k < open.size(); ++k) {
      corrections.middleCols(3 * static_cast<Eigen::Index>(k), 3) =
          system_.residual(goals[open[k]], x[open[k]]);
    }
    factor.solve_in_place(corrections);
    remove_block_means(system_.equations(), corrections);
    for (std::size_t k = 0; k < open.size(); ++k) {
      Convergence& own = reached[open[k]];
      own.iterations = pass;
      own.error =
          contraction_ * add_columns(corrections, 3 * static_cast<Eigen::Index>(k), x[open[k]]);
      own.reached = own.error <= tolerance;
    }
    std::erase_if(open, [&](std::size_t i) { return reached[i].reached; });
  }
  for (std::size_t i = 0; i < goals.size(); ++i) {
    const double scale = system_.right_hand_side(goals[i]).norm();
    const double residual = system_.residual(goals[i], x[i]).norm();
    reached[i].residual = scale > 0 ? residual / scale : residual;
    reached[i].reached = reached[i].reached || rows == 0;
  }
  return reached;
}

Preconditioner SurfaceSolver::preconditioner() const {
  if (const auto* multigrid = std::get_if<Multigrid>(&method_)) {
    return [multigrid](const Eigen::MatrixXd& r) { return Eigen::MatrixXd(multigrid->cycle(r)); };
  }
  return [&factor = std::get<IncompleteFactor>(method_)](const Eigen::MatrixXd& r) {
    return factor.solve(r);
  };
}

Iteration SurfaceSolver::iteration() const {
  const SymmetricSystem& equations = system_.equations();
  switch (choice_.solver) {
    case Solver::Jacobi:
      return [&equations](const auto& b, const StopRule& stop, auto& x) {
        return iterate_jacobi(equations, b, stop, x);
      };
    case Solver::GaussSeidel:
      return [&equations](const auto& b, const StopRule& stop, auto& x) {
        return iterate_gauss_seidel(equations, b, stop, x);
      };
    default:
      return [&equations, by = preconditioner()](const auto& b, const StopRule& stop, auto& x) {
        return iterate_conjugate_gradients(equations, by, b, stop, x);
      };
  }
}

}  // namespace morphbake
