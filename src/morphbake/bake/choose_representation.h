#pragma once

#include <memory>
#include <string>

#include "morphbake/connectivity/morphable_mesh.h"
#include "morphbake/diagnostics/observer.h"
#include "morphbake/recipe/recipe.h"
#include "morphbake/solve/rotation_blend.h"

namespace morphbake {

/// What is blended, and why.
struct RepresentationChoice {
  Representation representation = Representation::Laplacian;  ///< never Auto
  std::string reason;
  /// Of all shapes against the first; none where they are not turned.
  std::shared_ptr<const SourceDeformations> deformations;
};

/// As the recipe says; `auto` takes rotations where blended differences would shrink what is
/// turned, unless the shapes are turned too sharply for rotations between them to be clear, or the
/// recipe asks for what only plain differences give.
///
/// Warns of edges along which rotations turn by more than 0.8 rad.
RepresentationChoice choose_representation(const Recipe& recipe, const MorphableMesh& mesh,
                                           const Observer& observer);

}  // namespace morphbake
