#pragma once

#include <vector>

#include "morphbake/recipe/recipe.h"
#include "morphbake/sources/source_mesh.h"

namespace morphbake {

/// A copy of `recipe` whose regions and gauge stand at positions of the sources' scenes.
///
/// Vertices and triangles are those of the sources' files, which a shared connectivity no longer
/// knows.
/// @throws BakeError with all problems found: "landmarks.out-of-range", "landmarks.off-surface"
Recipe with_positions(Recipe recipe, const std::vector<SourceMesh>& sources);

}  // namespace morphbake
