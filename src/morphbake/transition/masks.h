#pragma once

#include <vector>

#include "morphbake/connectivity/morphable_mesh.h"
#include "morphbake/recipe/recipe.h"
#include "morphbake/sources/source_mesh.h"

namespace morphbake {

/// What the masks of a recipe mark on K: 1 is inside.
///
/// Each is read on the surface of the source's own file and carried to the closest vertices of K,
/// which are the same where the connectivity is shared. Materials and primitives are carried
/// triangle by triangle; a vertex is inside when a triangle around it is.
/// @param originals  one a source, in the scene where K's geometries are
/// @return           one a region: #V, each in [0, 1]; no rows for regions of another kind
/// @throws BakeError "recipe.mask" where a file has no such attribute, channel, material, primitive
///         or texture coordinates, or the image cannot be read; "gltf.accessor"
std::vector<Eigen::VectorXd> mask_values(const MorphableMesh& mesh, const Recipe& recipe,
                                         const std::vector<SourceMesh>& originals);

}  // namespace morphbake
