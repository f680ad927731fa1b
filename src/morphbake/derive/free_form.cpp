#include "morphbake/derive/free_form.h"

#include <fmt/core.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <string>
#include <utility>

#include "morphbake/diagnostics/problem.h"
#include "morphbake/differential/laplacian.h"
#include "morphbake/differential/rotation_vector.h"
#include "morphbake/linear/cholesky_factor.h"
#include "morphbake/linear/unknowns.h"
#include "morphbake/mesh/measures.h"
#include "morphbake/solve/surface_solver.h"

namespace morphbake {
namespace {

constexpr int kFree = -1, kFixed = -2;
constexpr double kTolerance = 1e-10;  ///< of the diagonal
constexpr double kStill = 1e-5;       ///< of the diagonal, a pass
constexpr int kMostPasses = 200;

std::string name_of_holder(int holder) {
  return holder == kFixed ? "what is fixed" : fmt::format("handle {}", holder);
}

/// Who says where each vertex is: the index of a handle, kFixed or kFree.
std::vector<int> holders_of(const std::vector<bool>& fixed, const std::vector<Handle>& handles) {
  std::vector<int> holders;
  for (const bool is_fixed : fixed) holders.push_back(is_fixed ? kFixed : kFree);
  int shared_count = 0;
  std::string first, pointer;
  for (std::size_t h = 0; h < handles.size(); ++h) {
    for (const int vertex : handles[h].vertices) {
      int& holder = holders.at(static_cast<std::size_t>(vertex));
      if (holder != kFree && shared_count++ == 0) {
        first = fmt::format("vertex {} belongs to {} and to handle {}", vertex,
                            name_of_holder(holder), h);
        pointer = fmt::format("/handles/{}", h);
      }
      holder = static_cast<int>(h);
    }
  }
  if (shared_count == 0) return holders;
  const std::string others =
      shared_count > 1 ? fmt::format("; so do {} other vertices", shared_count - 1) : "";
  throw BakeError(Problem{Severity::Error,
                          "derive.overlapping-handles",
                          {"", pointer, 0, 0},
                          first + others,
                          "each vertex belongs to one handle, is fixed, or is free"});
}

/// Displacements of the handles' vertices; 0 elsewhere.
Positions moves_of(const Mesh& mesh, const std::vector<Handle>& handles) {
  Positions moves = Positions::Zero(mesh.positions.rows(), 3);
  for (const Handle& handle : handles) {
    for (std::size_t k = 0; k < handle.vertices.size(); ++k) {
      const int vertex = handle.vertices[k];
      moves.row(vertex) =
          handle.positions.row(static_cast<Eigen::Index>(k)) - mesh.positions.row(vertex);
    }
  }
  return moves;
}

/// All vertices of components that no handle touches are held too: they are no unknowns then.
Constraints constraints_of(const Connectivity& connectivity, const std::vector<int>& holders) {
  const Components components = connected_components(one_rings(connectivity));
  std::vector<bool> is_moved(static_cast<std::size_t>(components.count), false);
  for (std::size_t v = 0; v < holders.size(); ++v) {
    if (holders[v] >= 0) is_moved[static_cast<std::size_t>(components.label[v])] = true;
  }
  Constraints constraints;
  for (std::size_t v = 0; v < holders.size(); ++v) {
    constraints.held.push_back(holders[v] != kFree ||
                               !is_moved[static_cast<std::size_t>(components.label[v])]);
  }
  constraints.gauge = Eigen::VectorXd::Zero(connectivity.vertex_count);
  constraints.anchor.assign(static_cast<std::size_t>(components.count), -1);
  return constraints;
}

/// Logarithms of turns and of growth, #V by 4: those of handles, 0 at what is fixed, each free
/// vertex's the mean of its neighbours'.
Eigen::MatrixXd harmonic_turns(const OneRings& rings, const std::vector<bool>& held,
                               const std::vector<Handle>& handles) {
  const auto count = static_cast<Eigen::Index>(held.size());
  Eigen::MatrixXd turns = Eigen::MatrixXd::Zero(count, 4);
  for (const Handle& handle : handles) {
    for (const int vertex : handle.vertices) {
      turns.row(vertex) << handle.turn.transpose(), std::log(handle.growth);
    }
  }
  const Unknowns unknowns(held);
  if (unknowns.rows.empty()) return turns;
  const Eigen::SparseMatrix<double> select = unknowns.selection();
  const Eigen::SparseMatrix<double> K = symmetric_laplacian(rings);
  const Eigen::SparseMatrix<double> rows = select.transpose() * K;
  SymmetricSystem system{rows * select, std::vector<int>(unknowns.rows.size(), -1), 0};
  const Eigen::MatrixXd b = -(rows * turns);
  turns(unknowns.rows, Eigen::all) = CholeskyFactor(system).solve(b);
  return turns;
}

/// What an edge becomes at each vertex.
using Maps = std::vector<Eigen::Matrix3d>;

Maps maps_of(const Eigen::MatrixXd& turns) {
  Maps maps;
  for (const auto& turn : turns.rowwise()) {
    maps.push_back(std::exp(turn(3)) * rotation_of(turn.head<3>().transpose()).toRotationMatrix());
  }
  return maps;
}

/// The rotations that fit `moved` best, each grown as before.
Maps fitted_maps(const OneRings& rings, const Positions& rest, const Positions& moved,
                 const Eigen::MatrixXd& turns) {
  Maps maps;
  for (Eigen::Index i = 0; i < rest.rows(); ++i) {
    const auto v = static_cast<std::size_t>(i);
    Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
    for (int n = rings.offsets[v]; n < rings.offsets[v + 1]; ++n) {
      const int j = rings.neighbours[static_cast<std::size_t>(n)];
      covariance += (moved.row(i) - moved.row(j)).transpose() * (rest.row(i) - rest.row(j));
    }
    maps.push_back(std::exp(turns(i, 3)) * nearest_rotation(covariance));
  }
  return maps;
}

/// b of K_L V = b from the mesh's edges, mapped.
Positions mapped_differences(const OneRings& rings, const Positions& positions, const Maps& maps) {
  Positions b = Positions::Zero(positions.rows(), 3);
  for (std::size_t v = 0; v < maps.size(); ++v) {
    const auto i = static_cast<Eigen::Index>(v);
    for (int n = rings.offsets[v]; n < rings.offsets[v + 1]; ++n) {
      const int j = rings.neighbours[static_cast<std::size_t>(n)];
      const Eigen::Vector3d edge = (positions.row(i) - positions.row(j)).transpose();
      b.row(i) += ((maps[v] + maps[static_cast<std::size_t>(j)]) / 2 * edge).transpose();
    }
  }
  return b;
}

bool turns_or_grows(const Handle& handle) { return handle.turn.norm() > 0 || handle.growth != 1; }

/// One a component: whether nothing of it is free.
std::vector<bool> held_components(const DisplacementSystem& system) {
  std::vector<bool> all_held(static_cast<std::size_t>(system.components().count), true);
  const std::vector<bool>& held = system.constraints().held;
  for (std::size_t v = 0; v < held.size(); ++v) {
    if (!held[v]) all_held[static_cast<std::size_t>(system.components().label[v])] = false;
  }
  return all_held;
}

/// Displacement for one goal, from where `x` is.
Positions solved(const SurfaceSolver& solver, const Goal& goal, std::vector<Eigen::MatrixXd>& x) {
  solver.solve({goal}, x);
  return solver.system().displacement(goal, x[0]);
}

/// Differences turned with the handles first; then, in turn, as what came out is turned, and the
/// positions for these, until they stand still.
Positions turned_form(const SurfaceSolver& solver, const Mesh& mesh, const Positions& moves,
                      const std::vector<Handle>& handles, const Observer& observer) {
  const DisplacementSystem& system = solver.system();
  const OneRings rings = one_rings({static_cast<int>(mesh.positions.rows()), mesh.triangles});
  const Eigen::MatrixXd turns = harmonic_turns(rings, system.constraints().held, handles);
  const std::vector<bool> is_held = held_components(system);
  Maps maps = maps_of(turns);
  const Positions goals = mesh.positions + moves;
  Positions moved = mesh.positions;
  std::vector<Eigen::MatrixXd> x;
  for (int pass = 0; pass < kMostPasses; ++pass) {
    stop_if_cancelled(observer);
    const Goal goal = system.goal_of_shape(mapped_differences(rings, mesh.positions, maps), goals,
                                           is_held, mesh.positions, goals);
    if (goal.is_blend()) return goals;
    if (x.empty()) x.push_back(system.start(goal));
    const Positions next = mesh.positions + solved(solver, goal, x);
    const double step = largest_distance(next, moved);
    moved = next;
    if (step < kStill * system.diagonal()) break;
    maps = fitted_maps(rings, mesh.positions, moved, turns);
  }
  return moved;
}

}  // namespace

Positions free_form(const Mesh& mesh, const std::vector<bool>& fixed,
                    const std::vector<Handle>& handles, Surroundings surroundings,
                    const Observer& observer) {
  assert(fixed.size() == static_cast<std::size_t>(mesh.positions.rows()));
  const std::vector<int> holders = holders_of(fixed, handles);
  MorphableMesh shape;
  shape.connectivity = {static_cast<int>(mesh.positions.rows()), mesh.triangles};
  shape.geometries = {mesh.positions};
  const DisplacementSystem system(shape, constraints_of(shape.connectivity, holders),
                                  RightHandSide::Edge);
  const Positions moves = moves_of(mesh, handles);
  SolveOptions options;
  options.tolerance = kTolerance;
  const bool turns = surroundings == Surroundings::Turned &&
                     std::any_of(handles.begin(), handles.end(), turns_or_grows);
  Positions moved = mesh.positions;
  if (turns) {
    moved = turned_form(SurfaceSolver(system, options, observer), mesh, moves, handles, observer);
  } else if (const Goal goal = system.goal_of_moves(moves); goal.is_blend()) {
    moved += goal.blend;
  } else {
    std::vector<Eigen::MatrixXd> x = {system.start(goal)};
    moved += solved(SurfaceSolver(system, options, observer), goal, x);
  }
  for (const Handle& handle : handles) moved(handle.vertices, Eigen::all) = handle.positions;
  return moved;
}

}  // namespace morphbake
