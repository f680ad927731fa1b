#pragma once

#include <Eigen/SparseCholesky>

#include "morphbake/connectivity/morphable_mesh.h"
#include "morphbake/mesh/adjacency.h"

namespace morphbake::test {

/// The first two sources interpolated as rigidly as possible, to compare with: the plainest way,
/// every frame relaxed until it stands still.
///
/// Minimises sum_ij (1 - t) |v_ij - R_i a_ij|^2 + t |v_ij - Q_i b_ij|^2 over the positions V' and a
/// rotation R_i and Q_i each vertex, all edges alike.
/// @see Sorkine and Alexa 2007, As-rigid-as-possible surface modeling
class ArapInterpolation {
 public:
  /// @param mesh  in one piece; must outlive this
  explicit ArapInterpolation(const MorphableMesh& mesh);

  /// @param start  #V by 3: where the relaxation begins
  Positions at(double t, const Positions& start) const;

 private:
  Positions target_differences(double t, const Positions& positions) const;

  const MorphableMesh& mesh_;
  OneRings rings_;
  Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> factor_;  ///< K_L without the first vertex
};

}  // namespace morphbake::test
