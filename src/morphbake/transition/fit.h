#pragma once

#include "morphbake/connectivity/morphable_mesh.h"
#include "morphbake/recipe/recipe.h"
#include "morphbake/transition/region_fields.h"

namespace morphbake {

/// Replaces what edits with a `fit` lead to by shapes of their own, turned (and scaled) so that the
/// soft ring of their region lies on that of the start, in the least-squares sense.
///
/// That is the paper's matrix S_i in front of a source's differential coordinates, the same for all
/// vertices of the region: regions of other size or orientation fit into their surroundings.
/// @param recipe  gets shares of the new shapes
/// @param mesh    gets their geometries and names
/// @throws BakeError "recipe.cannot-fit": a region that moves, or whose ring has no extent
/// @see    Alexa 2003, section 4.1; Umeyama 1991
void fit_edits(Recipe& recipe, MorphableMesh& mesh, const RegionFields& regions);

/// The map x -> c R x + t that brings `from` closest to `to`, in weighted least squares.
///
/// @param from, to  #P by 3
/// @param weights   #P, >= 0, not all 0
/// @param scales    whether c may differ from 1
/// @return          `from` mapped; no rows when the points have no extent that shows a rotation
Positions fitted(const Positions& from, const Positions& to, const Eigen::VectorXd& weights,
                 bool scales);

}  // namespace morphbake
