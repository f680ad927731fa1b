#pragma once

#include <vector>

#include "morphbake/diagnostics/observer.h"
#include "morphbake/mesh/mesh.h"

namespace morphbake {

/// Vertices that are moved together, and where each is put.
struct Handle {
  std::vector<int> vertices;
  Positions positions;  ///< one row a vertex
};

/// Free-form modelling (section 6 of the paper): fixed vertices stay to the last bit, those of the
/// handles are put where they shall be, and the others take the positions V' that minimise
///
///   |L V' - W|^2,  W = L V   (eq. 8),
///
/// with L = I - Deg^-1 A of all vertices, also of those that cannot move. Components are solved by
/// themselves: one without a handle stays, whatever is fixed; one that nothing fixes follows its
/// handles, and is translated where these are all translated alike. The free positions are within
/// 1e-10 of the diagonal of the minimum, by the solver's estimate. Handles that turn or
/// grow do that to what is free only near them: L is not invariant to either.
///
/// @param fixed  #V
/// @return       #V by 3
/// @throws BakeError "derive.overlapping-handles" at /handles/N, "solve.not-finite",
///         "solve.no-convergence", "linear.out-of-memory"; Cancelled
/// @see    Alexa 2003, section 6, eq. 8
Positions free_form(const Mesh& mesh, const std::vector<bool>& fixed,
                    const std::vector<Handle>& handles, const Observer& observer = {});

}  // namespace morphbake
