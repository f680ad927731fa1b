#include "morphbake/solve/displacement_system.h"

#include <fmt/core.h>

#include <algorithm>
#include <utility>

#include "morphbake/diagnostics/problem.h"
#include "morphbake/differential/laplacian.h"
#include "morphbake/mesh/measures.h"

namespace morphbake {
namespace {

using ExtendedRow = Eigen::Matrix<long double, 1, 3>;

/// Calls `visit(j)` for the neighbours j of vertex i.
template <typename Visit>
void for_each_neighbour(const OneRings& rings, Eigen::Index i, const Visit& visit) {
  const auto v = static_cast<std::size_t>(i);
  for (int n = rings.offsets[v]; n < rings.offsets[v + 1]; ++n) {
    visit(static_cast<Eigen::Index>(rings.neighbours[static_cast<std::size_t>(n)]));
  }
}

/// Of some columns, that lie together: e_i -= sum_j (x_i - x_j).
template <int kColumns>
void subtract_differences(const OneRings& rings, Eigen::Index i, Eigen::Index column,
                          const ColumnRows& x, ColumnRows& e) {
  using Row = Eigen::Array<double, 1, kColumns>;
  const auto row_of = [&](Eigen::Index v) { return Eigen::Map<const Row>(&x(v, column)); };
  Eigen::Map<Row> to(&e(i, column));
  const Row own = row_of(i);
  Row sum = to;
  for_each_neighbour(rings, i, [&](Eigen::Index j) { sum -= own - row_of(j); });
  to = sum;
}

/// Of all columns, three a goal: as many at a time as registers hold.
void subtract_differences(const OneRings& rings, Eigen::Index i, const ColumnRows& x,
                          ColumnRows& e) {
  constexpr int kTogether = 12;
  Eigen::Index column = 0;
  for (; column + kTogether <= x.cols(); column += kTogether) {
    subtract_differences<kTogether>(rings, i, column, x, e);
  }
  for (; column < x.cols(); column += 3) subtract_differences<3>(rings, i, column, x, e);
}

/// Means of each component's vertices: #components by 3.
Positions component_centres(const Components& components, const Positions& positions) {
  Positions sums = Positions::Zero(components.count, 3);
  Eigen::VectorXd counts = Eigen::VectorXd::Zero(components.count);
  for (Eigen::Index v = 0; v < positions.rows(); ++v) {
    const int component = components.label[static_cast<std::size_t>(v)];
    sums.row(component) += positions.row(v);
    counts(component) += 1;
  }
  return counts.cwiseInverse().asDiagonal() * sums;
}

std::vector<bool> uniform_components(const Components& components, const Eigen::MatrixXd& shares) {
  std::vector<bool> uniform(static_cast<std::size_t>(components.count), true);
  int uniform_count = components.count;
  const auto count = static_cast<Eigen::Index>(components.label.size());
  for (Eigen::Index block = 0; block < shares.cols(); block += count) {  // one, or one an axis
    std::vector<Eigen::Index> first(static_cast<std::size_t>(components.count), -1);
    for (Eigen::Index v = 0; v < count && uniform_count > 0; ++v) {
      const auto component =
          static_cast<std::size_t>(components.label[static_cast<std::size_t>(v)]);
      if (first[component] < 0) first[component] = v;
      if (uniform[component] && shares.col(block + v) != shares.col(block + first[component])) {
        uniform[component] = false;
        --uniform_count;
      }
    }
  }
  return uniform;
}

/// g_i = sum_s sum_j |T_s,i - T_s,j|: how much the shares of one axis vary around each vertex.
Eigen::VectorXd share_variation(const OneRings& rings, const Eigen::MatrixXd& shares) {
  Eigen::VectorXd variation = Eigen::VectorXd::Zero(shares.cols());
  for (Eigen::Index i = 0; i < shares.cols(); ++i) {
    for_each_neighbour(rings, i, [&](Eigen::Index j) {
      variation(i) += (shares.col(i) - shares.col(j)).cwiseAbs().sum();
    });
  }
  return variation;
}

void require_finite(const Positions& displacements, const char* what, const char* hint) {
  if (displacements.allFinite()) return;
  throw BakeError(Problem{Severity::Error,
                          "solve.not-finite",
                          {},
                          fmt::format("the {} positions are not finite numbers", what),
                          hint});
}

}  // namespace

bool Goal::is_blend() const {
  return std::find(uniform.begin(), uniform.end(), false) == uniform.end();
}

DisplacementSystem::DisplacementSystem(const MorphableMesh& mesh, Constraints constraints,
                                       RightHandSide rule)
    : mesh_(mesh),
      rings_(one_rings(mesh.connectivity)),
      components_(connected_components(rings_)),
      constraints_(std::move(constraints)),
      rule_(rule),
      unknowns_(constraints_.held),
      is_free_(unknown_parts(unknowns_, components_.label, components_.count)),
      diagonal_(bounding_diagonal(mesh.geometries.front())) {
  for (const Positions& geometry : mesh.geometries) {
    centres_.push_back(component_centres(components_, geometry));
  }
  assemble();
}

/// K_L for components that hold nothing, L_F^T L_F for the others, where L_F are the columns of L
/// that belong to free vertices.
void DisplacementSystem::assemble() {
  std::vector<Eigen::Triplet<double>> harmonic, columns;
  const auto holds = [&](Eigen::Index v) {
    return !is_free_[static_cast<std::size_t>(components_.label[static_cast<std::size_t>(v)])];
  };
  const auto unknown = [&](Eigen::Index v) {
    return unknowns_.of_row[static_cast<std::size_t>(v)];
  };
  const int vertex_count = mesh_.connectivity.vertex_count;
  for (int i = 0; i < vertex_count; ++i) {
    const double degree = rings_.degree(i);
    if (holds(i)) {
      if (unknown(i) >= 0) columns.emplace_back(i, unknown(i), 1.0);
      for_each_neighbour(rings_, i, [&](Eigen::Index j) {
        if (unknown(j) >= 0) columns.emplace_back(i, unknown(j), -1 / degree);
      });
    } else {
      harmonic.emplace_back(unknown(i), unknown(i), degree);
      for_each_neighbour(
          rings_, i, [&](Eigen::Index j) { harmonic.emplace_back(unknown(i), unknown(j), -1.0); });
    }
  }
  const auto unknown_count = static_cast<Eigen::Index>(unknowns_.rows.size());
  equations_.matrix.resize(unknown_count, unknown_count);
  equations_.matrix.setFromTriplets(harmonic.begin(), harmonic.end());
  if (!columns.empty()) {
    Eigen::SparseMatrix<double> L_F(vertex_count, unknown_count);
    L_F.setFromTriplets(columns.begin(), columns.end());
    const Eigen::SparseMatrix<double> L_F_transposed = L_F.transpose();
    const Eigen::SparseMatrix<double> squared = L_F_transposed * L_F;
    equations_.matrix = equations_.matrix + squared;
  }
  number_singular_blocks(unknowns_, components_.label, is_free_, equations_);
}

/// Makes K_L u = b solvable: b must sum to 0 over each component that holds nothing.
///
/// `edge` does by itself. For `vertex` the imbalance is spread where the shares vary, or, with an
/// anchor, thrown into its equation, as section 4.3 of the paper does by dropping it.
void DisplacementSystem::balance(const Eigen::MatrixXd& change, Goal& goal) const {
  const Eigen::Index count = goal.differences.rows();
  const bool is_per_axis = change.cols() > count;
  Eigen::VectorXd variation;
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    if (axis == 0 || is_per_axis) {
      variation = share_variation(rings_, change.middleCols(is_per_axis ? axis * count : 0, count));
    }
    balance_axis(variation, axis, goal);
  }
}

void DisplacementSystem::balance_axis(const Eigen::VectorXd& variation, Eigen::Index axis,
                                      Goal& goal) const {
  Eigen::VectorXd sums = Eigen::VectorXd::Zero(components_.count), variations = sums;
  auto b = goal.differences.col(axis);
  for (Eigen::Index v = 0; v < variation.size(); ++v) {
    const int component = components_.label[static_cast<std::size_t>(v)];
    sums(component) += b(v);
    variations(component) += variation(v);
  }
  for (Eigen::Index v = 0; v < variation.size(); ++v) {
    const int component = components_.label[static_cast<std::size_t>(v)];
    const auto c = static_cast<std::size_t>(component);
    if (!is_free_[c] || !(variations(component) > 0)) continue;
    if (constraints_.anchor[c] < 0) {
      b(v) -= variation(v) / variations(component) * sums(component);
    } else if (constraints_.anchor[c] == v) {
      b(v) -= sums(component);
      goal.imbalance(component, axis) = sums(component);
    }
  }
}

/// sum_s dT_s V_s, vertex by vertex: what linear interpolation of positions would give; and the
/// same of sources about the centres of their components.
void DisplacementSystem::blend(const Eigen::MatrixXd& change, Goal& goal) const {
  const Eigen::Index count = mesh_.connectivity.vertex_count;
  const Eigen::Index stride = change.cols() > count ? count : 0;
  const std::vector<Eigen::Index> sources = sources_with_weights(change);
  goal.blend.resize(count, 3);
  goal.start.resize(count, 3);
  for (Eigen::Index v = 0; v < count; ++v) {
    const int component = components_.label[static_cast<std::size_t>(v)];
    for (Eigen::Index axis = 0; axis < 3; ++axis) {
      const auto shares = change.col(v + axis * stride);
      double blend = 0;
      for (const Eigen::Index s : sources) {
        blend += shares(s) * mesh_.geometries[static_cast<std::size_t>(s)](v, axis);
      }
      double start = blend;
      for (const Eigen::Index s : sources) {
        start -= shares(s) * centres_[static_cast<std::size_t>(s)](component, axis);
      }
      goal.blend(v, axis) = blend;
      goal.start(v, axis) = start;
    }
  }
}

Goal DisplacementSystem::goal(const Eigen::MatrixXd& change) const {
  Goal goal;
  goal.uniform = uniform_components(components_, change);
  goal.imbalance = Positions::Zero(components_.count, 3);
  blend(change, goal);
  require_finite(goal.blend, "blended",
                 "the sources' coordinates are too large for double precision");
  if (goal.is_blend()) {
    goal.start = goal.blend;
  } else if (rule_ == RightHandSide::Edge) {
    goal.differences = blend_edge_differences(rings_, mesh_.geometries, change);
  } else {
    goal.differences = blend_vertex_differences(rings_, mesh_.geometries, change);
    balance(change, goal);
  }
  return goal;
}

Goal DisplacementSystem::goal_of_shape(const Positions& b, const Positions& blend,
                                       std::vector<bool> is_blend, const Positions& reference,
                                       const Positions& start) const {
  Goal goal;
  goal.blend = blend - reference;
  goal.start = start - reference;
  goal.uniform = std::move(is_blend);
  goal.imbalance = Positions::Zero(components_.count, 3);
  require_finite(goal.blend, "blended",
                 "the sources' coordinates are too large for double precision");
  goal.differences = b;
  for (Eigen::Index i = 0; i < reference.rows(); ++i) {
    for_each_neighbour(rings_, i, [&](Eigen::Index j) {
      goal.differences.row(i) -= reference.row(i) - reference.row(j);
    });
  }
  return goal;
}

Goal DisplacementSystem::goal_of_moves(const Positions& moves) const {
  Goal goal;
  goal.blend = Positions::Zero(moves.rows(), 3);
  goal.differences = Positions::Zero(moves.rows(), 3);
  goal.imbalance = Positions::Zero(components_.count, 3);
  goal.uniform.assign(static_cast<std::size_t>(components_.count), true);
  Positions first = Positions::Zero(components_.count, 3);
  std::vector<bool> is_known(goal.uniform.size(), false);
  for (Eigen::Index v = 0; v < moves.rows(); ++v) {
    const auto vertex = static_cast<std::size_t>(v);
    const auto component = static_cast<std::size_t>(components_.label[vertex]);
    if (!constraints_.held[vertex]) continue;
    goal.blend.row(v) = moves.row(v);
    if (!is_known[component]) first.row(components_.label[vertex]) = moves.row(v);
    is_known[component] = true;
    if (moves.row(v) != first.row(components_.label[vertex])) goal.uniform[component] = false;
  }
  require_finite(goal.blend, "moved", "move vertices to numbers");
  for (const int v : unknowns_.rows) {
    const int component = components_.label[static_cast<std::size_t>(v)];
    if (goal.uniform[static_cast<std::size_t>(component)]) goal.blend.row(v) = first.row(component);
  }
  goal.start = goal.blend;
  return goal;
}

Eigen::MatrixXd DisplacementSystem::rest() const {
  const Positions& V = mesh_.geometries.front();
  const Eigen::RowVector3d centre = (V.colwise().minCoeff() + V.colwise().maxCoeff()) / 2;
  return (V.rowwise() - centre)(unknowns_.rows, Eigen::all);
}

Eigen::MatrixXd DisplacementSystem::start(const Goal& goal) const {
  if (!holds()) return goal.start;
  return goal.start(unknowns_.rows, Eigen::all);
}

Eigen::MatrixXd DisplacementSystem::right_hand_side(const Goal& goal) const {
  if (!holds()) return goal.differences;
  return held_residual(goal, Eigen::MatrixXd::Zero(equations_.matrix.rows(), 3));
}

Eigen::MatrixXd DisplacementSystem::residual(const Goal& goal, const Eigen::MatrixXd& x) const {
  if (!holds()) return residuals({&goal}, x);
  return held_residual(goal, x);
}

ColumnRows DisplacementSystem::residuals(const std::vector<const Goal*>& goals,
                                         const ColumnRows& x) const {
  ColumnRows residuals(x.rows(), x.cols());
  const auto columns_of = [](std::size_t goal) { return 3 * static_cast<Eigen::Index>(goal); };
  if (holds()) {
    for (std::size_t g = 0; g < goals.size(); ++g) {
      residuals.middleCols<3>(columns_of(g)) =
          held_residual(*goals[g], x.middleCols<3>(columns_of(g)));
    }
    return residuals;
  }
  // Vertices are unknowns here. Some at a time: the goals' columns lie far apart.
  constexpr Eigen::Index kVertices = 64;
  for (Eigen::Index first = 0; first < x.rows(); first += kVertices) {
    const Eigen::Index count = std::min(kVertices, x.rows() - first);
    for (std::size_t g = 0; g < goals.size(); ++g) {
      residuals.middleCols<3>(columns_of(g)).middleRows(first, count) =
          goals[g]->differences.middleRows(first, count);
    }
    for (Eigen::Index i = first; i < first + count; ++i) {
      subtract_differences(rings_, i, x, residuals);
    }
  }
  return residuals;
}

Eigen::MatrixXd DisplacementSystem::held_residual(const Goal& goal,
                                                  const Eigen::MatrixXd& x) const {
  Positions u = goal.blend;  // held vertices stay there
  for (std::size_t k = 0; k < unknowns_.rows.size(); ++k) {
    u.row(unknowns_.rows[k]) = x.row(static_cast<Eigen::Index>(k));
  }
  // e = b - K_L u. Extended precision where L^T is still to be applied to it.
  Eigen::Matrix<long double, Eigen::Dynamic, 3, Eigen::RowMajor> misfit;
  misfit.setZero(u.rows(), 3);
  Eigen::MatrixXd residual(x.rows(), 3);
  for (Eigen::Index i = 0; i < u.rows(); ++i) {
    const auto vertex = static_cast<std::size_t>(i);
    if (!is_free_[static_cast<std::size_t>(components_.label[vertex])]) {
      ExtendedRow e = goal.differences.row(i).cast<long double>();
      const ExtendedRow own = u.row(i).cast<long double>();
      for_each_neighbour(rings_, i,
                         [&](Eigen::Index j) { e -= own - u.row(j).cast<long double>(); });
      misfit.row(i) = e / static_cast<long double>(rings_.degree(static_cast<int>(i)));
    } else {
      Eigen::RowVector3d e = goal.differences.row(i);
      for_each_neighbour(rings_, i, [&](Eigen::Index j) { e -= u.row(i) - u.row(j); });
      residual.row(unknowns_.of_row[vertex]) = e;
    }
  }
  for (std::size_t k = 0; k < unknowns_.rows.size(); ++k) {
    const Eigen::Index i = unknowns_.rows[k];
    const auto component = static_cast<std::size_t>(components_.label[static_cast<std::size_t>(i)]);
    if (is_free_[component]) continue;
    ExtendedRow sum = misfit.row(i);  // column i of L: 1 at i, -1 / deg_j at its neighbours j
    for_each_neighbour(rings_, i, [&](Eigen::Index j) {
      sum -= misfit.row(j) / static_cast<long double>(rings_.degree(static_cast<int>(j)));
    });
    residual.row(static_cast<Eigen::Index>(k)) = sum.cast<double>();
  }
  return residual;
}

Positions DisplacementSystem::displacement(const Goal& goal, const Eigen::MatrixXd& x) const {
  Positions u = goal.blend;
  Positions offsets = Positions::Zero(components_.count, 3);
  const auto is_solved = [&](Eigen::Index v) {
    const auto vertex = static_cast<std::size_t>(v);
    return unknowns_.of_row[vertex] >= 0 &&
           !goal.uniform[static_cast<std::size_t>(components_.label[vertex])];
  };
  for (Eigen::Index v = 0; v < u.rows(); ++v) {
    if (!is_solved(v)) continue;
    u.row(v) = x.row(unknowns_.of_row[static_cast<std::size_t>(v)]);
    const int component = components_.label[static_cast<std::size_t>(v)];
    offsets.row(component) += constraints_.gauge(v) * (goal.blend.row(v) - u.row(v));
  }
  for (Eigen::Index v = 0; v < u.rows(); ++v) {
    const int component = components_.label[static_cast<std::size_t>(v)];
    if (is_solved(v) && is_free_[static_cast<std::size_t>(component)]) {
      u.row(v) += offsets.row(component);
    }
  }
  return u;
}

}  // namespace morphbake
