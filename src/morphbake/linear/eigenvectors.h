#pragma once

#include <Eigen/Core>

#include "morphbake/diagnostics/observer.h"
#include "morphbake/mesh/adjacency.h"

namespace morphbake {

/// Eigenvectors of a mesh's Laplacian, a Fourier basis of its surface: K_L u = lambda Deg u.
struct SpectralBasis {
  Eigen::VectorXd eigenvalues;  ///< rising, in [0, 2]; 0 once a component
  Eigen::MatrixXd vectors;      ///< #V by #eigenvalues: U with U^T Deg U = I
  Eigen::VectorXd residuals;    ///< |Deg^-1/2 (K_L u - lambda Deg u)|, one a pair
};

struct EigenvectorOptions {
  /// Convergence of a pair, relative to what the solver iterates on; 1e-14 to 1e-6.
  double tolerance = 1e-12;
  /// Restarts of one component's iteration before it counts as not converging.
  int max_restarts = 300;
};

/// The `count` smallest eigenpairs of the symmetric normalised Laplacian S = Deg^-1/2 K_L Deg^-1/2
/// of the one-rings, and all whose eigenvalue equals the last one's (to 1e-9, relative): a part of
/// its space would be any part. U = Deg^-1/2 times its eigenvectors.
///
/// The constants of each component come first. The remark of the paper that the Laplacian is normal
/// holds for regular meshes only, hence S. None is missed: the inertia of K_L - mu Deg says how
/// many pairs each component has below a mu, and that many are found. Of an eigenvalue that occurs
/// several times any vectors that span its space may come. Start vectors are fixed, and of the
/// largest entries of a vector the first is positive: one machine gives the same bytes every time.
///
/// @param count    1 to #V; a vertex without neighbours has degree 1 here
/// @throws BakeError "linear.no-eigenvectors", "linear.out-of-memory"; Cancelled
/// @cost  #V count; a component whose pairs are nearly all wanted: as a dense matrix, #V^3
/// @see   Alexa 2003, section 5.1; Karni and Gotsman 2000
SpectralBasis smallest_eigenvectors(const OneRings& rings, int count,
                                    const EigenvectorOptions& options = {},
                                    const Observer& observer = {});

/// `count`, or as many more as have the same eigenvalue.
int whole_count(const SpectralBasis& basis, int count);

}  // namespace morphbake
