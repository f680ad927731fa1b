#pragma once

#include <vector>

#include "morphbake/connectivity/morphable_mesh.h"
#include "morphbake/linear/symmetric_system.h"
#include "morphbake/linear/unknowns.h"
#include "morphbake/mesh/adjacency.h"
#include "morphbake/solve/constraints.h"
#include "morphbake/solve/solve_options.h"

namespace morphbake {

/// What one change of shares, or a move of held vertices, asks of the surface.
struct Goal {
  Positions differences;  ///< #V by 3: b of K_L u = b, in components with varying shares
  Positions blend;        ///< #V by 3: sum_s dT_s V_s, vertex by vertex; or the moves
  Positions start;        ///< #V by 3: the blend of sources whose components share their centres
  std::vector<bool>
      uniform;          ///< one a component: all its vertices change alike, and take the blend
  Positions imbalance;  ///< one a component: what was put into the anchor's equation

  /// Whether the blend is the answer everywhere.
  bool is_blend() const;
};

/// The linear system of one morphable mesh, in displacements u from the reference mix sum_s T_s
/// V_s.
///
/// Components that hold nothing solve K_L u = b(dT). Those that hold vertices keep them at the
/// blend and minimise |L u - Deg^-1 b(dT)|^2 over the others (Alexa 2003, eq. 8; biharmonic). All
/// is linear in dT. Displacements, not positions: L^T L loses digits in proportion to what it is
/// applied to, and what does not move is exactly 0.
class DisplacementSystem {
 public:
  /// @param mesh  must outlive the system
  DisplacementSystem(const MorphableMesh& mesh, Constraints constraints, RightHandSide rule);

  const SymmetricSystem& equations() const { return equations_; }

  const Components& components() const { return components_; }

  const Constraints& constraints() const { return constraints_; }

  bool holds() const { return held_count() > 0; }

  int held_count() const {
    return static_cast<int>(unknowns_.of_row.size() - unknowns_.rows.size());
  }

  double diagonal() const { return diagonal_; }

  /// @param change  dT: #sources by #V, or 3 #V as TransitionState; columns sum to 0
  /// @throws BakeError "solve.not-finite"
  Goal goal(const Eigen::MatrixXd& change) const;

  /// A shape of given differences, as displacements from another one.
  ///
  /// @param b          #V by 3, of K_L V = b: sums to 0 over each component
  /// @param blend      #V by 3: where held vertices stand, and what the gauge follows
  /// @param is_blend   one a component: whether the blend is the shape
  /// @param reference  #V by 3
  /// @param start      #V by 3: close to the shape
  /// @throws BakeError "solve.not-finite"
  Goal goal_of_shape(const Positions& b, const Positions& blend, std::vector<bool> is_blend,
                     const Positions& reference, const Positions& start) const;

  /// Held vertices displaced as given, and nothing else asked for: minimises |L u| over the others.
  ///
  /// Where all held vertices of a component move alike, so do the others, exactly; a component that
  /// holds nothing stays.
  /// @param moves  #V by 3; rows of vertices that are not held do not matter
  /// @throws BakeError "solve.not-finite"
  /// @see    Alexa 2003, eq. 8
  Goal goal_of_moves(const Positions& moves) const;

  /// b of equations() X = b: unknowns by 3.
  Eigen::MatrixXd right_hand_side(const Goal& goal) const;

  /// Right-hand side minus matrix times `x`; sums of held components run in extended precision.
  ///
  /// @param x  unknowns by 3
  /// @return   as x
  Eigen::MatrixXd residual(const Goal& goal, const Eigen::MatrixXd& x) const;

  /// The residuals of several goals, which walk over the surface together.
  ///
  /// @param x  unknowns by 3 a goal, beside each other
  /// @return   as x
  ColumnRows residuals(const std::vector<const Goal*>& goals, const ColumnRows& x) const;

  /// The first source's surface at the unknowns, about the centre of its bounding box.
  Eigen::MatrixXd rest() const;

  /// Where iterations start: the solution does not see how sources are placed, nor does this.
  Eigen::MatrixXd start(const Goal& goal) const;

  /// Displacements of all vertices: held ones at the blend, free components moved to the gauge.
  ///
  /// @return #V by 3
  Positions displacement(const Goal& goal, const Eigen::MatrixXd& x) const;

 private:
  void assemble();
  void balance(const Eigen::MatrixXd& change, Goal& goal) const;
  void balance_axis(const Eigen::VectorXd& variation, Eigen::Index axis, Goal& goal) const;
  void blend(const Eigen::MatrixXd& change, Goal& goal) const;
  Eigen::MatrixXd held_residual(const Goal& goal, const Eigen::MatrixXd& x) const;

  const MorphableMesh& mesh_;
  OneRings rings_;
  Components components_;
  Constraints constraints_;
  RightHandSide rule_;
  Unknowns unknowns_;          ///< what is not held
  std::vector<bool> is_free_;  ///< one a component: whether it holds nothing
  double diagonal_ = 0;
  std::vector<Positions> centres_;  ///< one a source: mean of each component's vertices
  SymmetricSystem equations_;
};

}  // namespace morphbake
