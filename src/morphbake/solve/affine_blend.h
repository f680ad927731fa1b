#pragma once

#include <Eigen/SparseCore>
#include <vector>

#include "morphbake/connectivity/morphable_mesh.h"
#include "morphbake/linear/symmetric_system.h"
#include "morphbake/linear/unknowns.h"
#include "morphbake/mesh/adjacency.h"
#include "morphbake/solve/constraints.h"
#include "morphbake/transition/timeline.h"

namespace morphbake {

/// The paper's affine independent representation: every vertex as a weighted sum of its neighbours,
/// whose weights sum to 1 and are blended.
///
/// Minimum-norm weights are of any size where neighbours are nearly in a plane, so they are drawn
/// towards uniform ones, and what they miss is kept as a displacement:
///
///   w_i minimises |v_i - sum_j w_ij v_j|^2 + (0.2 h_i)^2 |w_i - 1/deg_i|^2,  sum_j w_ij = 1
///   V' minimises  |V' - W V' - R|^2 + 0.03 |L V' - sum_s T_s L V_s|^2
///
/// with h_i the mean edge around i, and W and R blended by T. The matrix is another for each state.
/// @see Alexa 2003, section 4.2, eq. 4 and 5; docs/method.md, "Affine weights"
class AffineBlend {
 public:
  /// @param mesh         must outlive this
  /// @param constraints  of the system; what is held stays at `rest`
  AffineBlend(const MorphableMesh& mesh, const Constraints& constraints, Positions rest);

  /// @param T      #sources by #V
  /// @param mixed  #V by 3: sum_s T_s V_s, which components that hold nothing follow
  /// @return       #V by 3
  /// @throws BakeError "linear.out-of-memory", "linear.not-definite"
  /// @cost   a factorisation
  Positions shape(const TransitionState& T, const Positions& mixed) const;

 private:
  /// One source's representation.
  struct Weights {
    std::vector<double> of_neighbours;  ///< beside OneRings::neighbours
    Positions missed;                   ///< #V by 3: v_i - sum_j w_ij v_j
    Positions differences;              ///< #V by 3: L V
  };

  static Weights weights_of(const OneRings& rings, const Positions& positions);
  Eigen::SparseMatrix<double> affine_matrix(const TransitionState& T) const;
  void move_to_gauge(const Positions& mixed, Positions& shape) const;

  OneRings rings_;
  Components components_;
  Unknowns unknowns_;
  std::vector<bool> is_free_;           ///< one a component: whether it holds nothing
  Eigen::SparseMatrix<double> select_;  ///< #V by #unknowns: the columns of free vertices
  Eigen::VectorXd gauge_;
  Positions rest_;
  std::vector<Weights> weights_;           ///< one a source
  Eigen::SparseMatrix<double> laplacian_;  ///< L: #V by #V
  SymmetricSystem regularisation_;         ///< 0.03 L^T L of what is free
};

}  // namespace morphbake
