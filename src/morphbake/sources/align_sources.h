#pragma once

#include <vector>

#include "morphbake/diagnostics/observer.h"
#include "morphbake/recipe/recipe.h"
#include "morphbake/sources/source_mesh.h"

namespace morphbake {

/// Sources where the recipe's `align` puts them, and the recipe whose positions moved along.
struct AlignedSources {
  Recipe recipe;
  std::vector<SourceMesh> sources;
};

/// Whether one would hardly see `other` beside `first`: four times as large or as small, or that
/// many times its own radius away.
bool is_unlike(const SourceMesh& first, const SourceMesh& other);

/// Moves each source that says so onto the first one.
///
/// By the landmarks that both have, least squares (Umeyama 1991; the affine map by its normal
/// equations). With fewer than three: by centres of area, and a similarity by the surfaces' root
/// mean square radii, unturned. Warns "sources.unlike" of a source that is not aligned and much
/// larger, smaller or further away than the first one.
/// @param recipe  its regions and gauge stand at positions, see with_positions
/// @throws BakeError "landmarks.cannot-align": too few landmarks for an affine map, or all in one
///         line or (affine) plane, or a map that mirrors or flattens
AlignedSources align_sources(Recipe recipe, std::vector<SourceMesh> sources,
                             const Observer& observer);

}  // namespace morphbake
