#pragma once

#include <vector>

#include "morphbake/connectivity/morphable_mesh.h"
#include "morphbake/recipe/recipe.h"
#include "morphbake/sources/source_mesh.h"
#include "morphbake/transition/timeline.h"

namespace morphbake {

/// Colours of shapes: one a shape, #R by 3 linear RGB at the vertices of the first source's file;
/// none where all look alike, or where files cannot be compared.
using ShapeColours = std::vector<Positions>;

/// What COLOR_0 of the sources' files says, as new connectivities have it: opaque, on all
/// primitives, with one order of vertices and the same factors of materials. Shapes that are made
/// from others have the colours of the source from which they come.
ShapeColours shape_colours(const Recipe& recipe, const std::vector<SourceMesh>& sources);

/// sum_s T_s C_s within [0, 1], where axes mix by themselves of their mean share: #R by 3.
Positions mixed_colours(const ShapeColours& colours, const MorphableMesh& mesh,
                        const TransitionState& T);

}  // namespace morphbake
