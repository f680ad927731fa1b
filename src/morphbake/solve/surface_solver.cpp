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

/// What the goals that are not done with have reached, beside each other.
struct OpenGoals {
  std::vector<std::size_t> which;
  ColumnRows x;  ///< unknowns by 3 a goal

  /// Takes the starts out of where they are.
  explicit OpenGoals(std::vector<Eigen::MatrixXd>& starts) : which(starts.size()) {
    std::iota(which.begin(), which.end(), std::size_t{0});
    x.resize(starts.empty() ? 0 : starts[0].rows(), 3 * static_cast<Eigen::Index>(starts.size()));
    for_each_row_block([&](Eigen::Index first, Eigen::Index count) {
      for (std::size_t i = 0; i < starts.size(); ++i) {
        x.middleCols<3>(column_of(i)).middleRows(first, count) = starts[i].middleRows(first, count);
      }
    });
    for (Eigen::MatrixXd& start : starts) start.resize(0, 3);
  }

  static Eigen::Index column_of(std::size_t place) { return 3 * static_cast<Eigen::Index>(place); }

  /// Keeps those at some places, and their columns of `beside`; puts the others where they belong.
  void keep(const std::vector<std::size_t>& left, const std::vector<std::size_t>& done,
            std::vector<Eigen::MatrixXd>& solved, ColumnRows& beside) {
    if (done.empty()) return;
    std::vector<Eigen::Index> columns;
    std::vector<std::size_t> kept;
    for (const std::size_t place : left) {
      kept.push_back(which[place]);
      for (Eigen::Index c = 0; c < 3; ++c) columns.push_back(column_of(place) + c);
    }
    beside = ColumnRows(beside(Eigen::all, columns));  // first, since the largest sizes meet here
    for (const std::size_t place : done) solved[which[place]].resize(x.rows(), 3);
    for_each_row_block([&](Eigen::Index first, Eigen::Index count) {
      for (const std::size_t place : done) {
        solved[which[place]].middleRows(first, count) =
            x.middleCols<3>(column_of(place)).middleRows(first, count);
      }
    });
    which = std::move(kept);
    x = ColumnRows(x(Eigen::all, columns));
  }

 private:
  /// Matrices that lie apart are read and written some rows at a time: all of a block is at hand.
  template <typename Visit>
  void for_each_row_block(const Visit& visit) const {
    constexpr Eigen::Index kRows = 64;
    for (Eigen::Index first = 0; first < x.rows(); first += kRows) {
      visit(first, std::min(kRows, x.rows() - first));
    }
  }
};

std::vector<const Goal*> chosen_goals(const std::vector<Goal>& goals,
                                      const std::vector<std::size_t>& places) {
  std::vector<const Goal*> chosen;
  for (const std::size_t place : places) chosen.push_back(&goals[place]);
  return chosen;
}

/// One a goal, whose three columns lie beside the others'.
Eigen::ArrayXd norms_of_goals(const ColumnRows& columns) {
  Eigen::RowVectorXd squares = Eigen::RowVectorXd::Zero(columns.cols());
  for (Eigen::Index row = 0; row < columns.rows(); ++row) {
    squares += columns.row(row).cwiseAbs2();
  }
  return squares.reshaped(3, columns.cols() / 3).colwise().sum().cwiseSqrt().transpose();
}

/// Adds corrections of all goals, less what the system does not see of them.
///
/// @return  one a goal: the longest row that was added
Eigen::ArrayXd correct(const SymmetricSystem& system, const ColumnRows& corrections,
                       ColumnRows& x) {
  const ColumnRows means = block_means(system, corrections);
  Eigen::RowVectorXd added(x.cols());
  Eigen::ArrayXd longest = Eigen::ArrayXd::Zero(x.cols() / 3);
  for (Eigen::Index row = 0; row < x.rows(); ++row) {
    const int block = system.singular_block[static_cast<std::size_t>(row)];
    added = corrections.row(row);
    if (block >= 0) added -= means.row(block);
    x.row(row) += added;
    for (Eigen::Index goal = 0; goal < longest.size(); ++goal) {
      longest(goal) = std::max(longest(goal), added.segment<3>(3 * goal).squaredNorm());
    }
  }
  return longest.sqrt();
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
  std::vector<Convergence> reached(goals.size());
  for (Convergence& own : reached) own.reached = system_.equations().matrix.rows() == 0;
  OpenGoals open(x);  // each ends by itself
  for (int pass = 0; !open.which.empty(); ++pass) {
    ColumnRows corrections = system_.residuals(chosen_goals(goals, open.which), open.x);
    const Eigen::ArrayXd residuals = norms_of_goals(corrections);
    std::vector<std::size_t> done, left;
    for (std::size_t k = 0; k < open.which.size(); ++k) {
      Convergence& own = reached[open.which[k]];
      own.residual = residuals(static_cast<Eigen::Index>(k));
      (own.reached || pass == kCorrectionLimit ? done : left).push_back(k);
    }
    open.keep(left, done, x, corrections);
    if (left.empty()) break;
    factor.solve_in_place(corrections);
    const Eigen::ArrayXd added = correct(system_.equations(), corrections, open.x);
    for (std::size_t k = 0; k < left.size(); ++k) {
      Convergence& own = reached[open.which[k]];
      own.iterations = pass + 1;
      own.error = contraction_ * added(static_cast<Eigen::Index>(k));
      own.reached = own.error <= tolerance;
    }
  }
  for (std::size_t i = 0; i < goals.size(); ++i) {
    const double scale = system_.right_hand_side(goals[i]).norm();
    if (scale > 0) reached[i].residual /= scale;
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
