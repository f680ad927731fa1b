#pragma once

#include <vector>

#include "morphbake/diagnostics/observer.h"
#include "morphbake/mesh/mesh.h"

namespace morphbake {

/// Vertices that are moved together, and where each is put.
struct Handle {
  std::vector<int> vertices;
  Positions positions;                             ///< one row a vertex
  Eigen::Vector3d turn = Eigen::Vector3d::Zero();  ///< axis times angle: what they were turned by
  double growth = 1;                               ///< and scaled, > 0
};

/// What becomes of the differences W around handles that turn or grow.
enum class Surroundings {
  AsTheyAre,  ///< as in the paper: what is free follows only near the handles, and is sheared
  Turned,     ///< they turn and grow with the handles, the less the further away
};

/// Free-form modelling (section 6 of the paper): fixed vertices stay to the last bit, those of the
/// handles are put where they shall be, and the others take the positions V' that minimise
///
///   |L V' - W|^2,  W = L V   (eq. 8),
///
/// with L = I - Deg^-1 A of all vertices, also of those that cannot move. Components are solved by
/// themselves: one without a handle stays, whatever is fixed; one that nothing fixes follows its
/// handles, and is translated where these are all translated alike. The free positions are within
/// 1e-10 of the diagonal of the minimum, by the solver's estimate. L is not invariant to turns
/// and growth: where surroundings are turned, the handles' turns (as vectors, of any length) and
/// the logarithms of their growth are spread harmonically to what is free, 0 at what is fixed, and
/// W is what the differences along edges become by the means of their ends' turns. From there the
/// rotations that fit the result best and the positions for these are found in turn, until a pass
/// moves nothing by more than 1e-5 of the diagonal, 200 passes at most.
///
/// @param fixed  #V
/// @return       #V by 3
/// @throws BakeError "derive.overlapping-handles" at /handles/N, "solve.not-finite",
///         "solve.no-convergence", "linear.out-of-memory"; Cancelled
/// @see    Alexa 2003, section 6, eq. 8; Zayer et al. 2005, Harmonic guidance for surface
///         deformation; Sorkine and Alexa 2007, As-rigid-as-possible surface modeling
Positions free_form(const Mesh& mesh, const std::vector<bool>& fixed,
                    const std::vector<Handle>& handles,
                    Surroundings surroundings = Surroundings::AsTheyAre,
                    const Observer& observer = {});

}  // namespace morphbake
