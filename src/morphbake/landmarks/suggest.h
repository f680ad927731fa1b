#pragma once

#include <string>
#include <vector>

#include "morphbake/diagnostics/observer.h"
#include "morphbake/sources/source_surface.h"

namespace morphbake {

struct SuggestOptions {
  int count = 10;  ///< how many landmarks are wanted, 3 to 100; fewer where no more can be told
};

/// Corresponding points of two surfaces.
struct SuggestedLandmarks {
  std::vector<std::string> names;
  Positions a;  ///< one a name: scene coordinates on the first surface
  Positions b;  ///< on the second
};

/// Proposes landmarks for two surfaces.
///
/// Tips of protrusions that correspond come first ("tip_1", or "tip_2_left" and "tip_2_right"; left
/// is the side of +X), then tips that only one of the shapes has, where they would grow on the
/// other, then points of the rim ("rim_1") of open surfaces, then points far from all others
/// ("point_1"). Shapes are aligned first: they may be turned, scaled and, to some degree, posed.
/// Warns "landmarks.mirrored" when the second is a mirror image of the first,
/// "landmarks.uncertain" when few tips correspond, "landmarks.several-pieces".
/// @throws BakeError "landmarks.nothing-found"; Cancelled
/// @cost   half a minute for 508k and 187k vertices
SuggestedLandmarks suggest_landmarks(const SourceSurface& a, const SourceSurface& b,
                                     const SuggestOptions& options, const Observer& observer);

}  // namespace morphbake
