#pragma once

#include <vector>

#include "morphbake/connectivity/morphable_mesh.h"
#include "morphbake/recipe/recipe.h"
#include "morphbake/sources/source_mesh.h"
#include "morphbake/transition/timeline.h"

namespace morphbake {

/// Colours of shapes with one connectivity: one a shape, #V by 3 linear RGB; none where all look
/// alike.
using ShapeColours = std::vector<Positions>;

/// What COLOR_0 of the sources' new files says. Shapes that are made from others have the colours
/// of the source from which they come.
///
/// @param sources  with one order of vertices and one factor of their materials
ShapeColours shape_colours(const Recipe& recipe, const std::vector<SourceMesh>& sources,
                           const MorphableMesh& mesh);

/// sum_s T_s C_s within [0, 1], where axes mix by themselves of their mean share: #V by 3.
Positions mixed_colours(const ShapeColours& colours, const TransitionState& T);

}  // namespace morphbake
