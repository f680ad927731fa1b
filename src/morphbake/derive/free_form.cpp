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
#include "morphbake/solve/surface_solver.h"

namespace morphbake {
namespace {

constexpr int kFree = -1, kFixed = -2;
constexpr double kTolerance = 1e-10;  ///< of the diagonal

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
  std::vector<int> unknowns;
  for (std::size_t v = 0; v < held.size(); ++v) {
    if (!held[v]) unknowns.push_back(static_cast<int>(v));
  }
  if (unknowns.empty()) return turns;
  Eigen::SparseMatrix<double> select(count, static_cast<Eigen::Index>(unknowns.size()));
  select.reserve(Eigen::VectorXi::Ones(select.cols()));
  for (std::size_t i = 0; i < unknowns.size(); ++i) {
    select.insert(unknowns[i], static_cast<Eigen::Index>(i)) = 1;
  }
  const Eigen::SparseMatrix<double> K = symmetric_laplacian(rings);
  const Eigen::SparseMatrix<double> rows = select.transpose() * K;
  SymmetricSystem system{rows * select, std::vector<int>(unknowns.size(), -1), 0};
  const Eigen::MatrixXd b = -(rows * turns);
  turns(unknowns, Eigen::all) = CholeskyFactor(system).solve(b);
  return turns;
}

/// b of K_L V = b from the mesh's edges, turned and grown.
Positions turned_differences(const OneRings& rings, const Positions& positions,
                             const Eigen::MatrixXd& turns) {
  std::vector<Eigen::Matrix3d> maps;
  for (const auto& turn : turns.rowwise()) {
    maps.push_back(std::exp(turn(3)) * rotation_of(turn.head<3>().transpose()).toRotationMatrix());
  }
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

Goal goal_of(const DisplacementSystem& system, const Mesh& mesh, const std::vector<Handle>& handles,
             Surroundings surroundings) {
  const Positions moves = moves_of(mesh, handles);
  if (surroundings == Surroundings::AsTheyAre ||
      std::none_of(handles.begin(), handles.end(), turns_or_grows)) {
    return system.goal_of_moves(moves);
  }
  const OneRings rings = one_rings({static_cast<int>(mesh.positions.rows()), mesh.triangles});
  const std::vector<bool>& held = system.constraints().held;
  const Positions b =
      turned_differences(rings, mesh.positions, harmonic_turns(rings, held, handles));
  std::vector<bool> all_held(static_cast<std::size_t>(system.components().count), true);
  for (std::size_t v = 0; v < held.size(); ++v) {
    if (!held[v]) all_held[static_cast<std::size_t>(system.components().label[v])] = false;
  }
  return system.goal_of_shape(b, mesh.positions + moves, std::move(all_held), mesh.positions);
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
  const Goal goal = goal_of(system, mesh, handles, surroundings);
  Positions moved = mesh.positions;
  if (goal.is_blend()) {
    moved += goal.blend;
  } else {
    SolveOptions options;
    options.tolerance = kTolerance;
    const SurfaceSolver solver(system, options, observer);
    std::vector<Eigen::MatrixXd> x = {system.start(goal)};
    solver.solve({goal}, x);
    moved += system.displacement(goal, x[0]);
  }
  for (const Handle& handle : handles) moved(handle.vertices, Eigen::all) = handle.positions;
  return moved;
}

}  // namespace morphbake
