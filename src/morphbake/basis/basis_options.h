#pragma once

namespace morphbake {

/// How frames become morph targets and weights.
struct BasisOptions {
  /// Largest distance that linear keys may cut off an eased weight curve, as a fraction of the
  /// bounding-box diagonal; smaller writes more keys.
  double easing_tolerance = 1e-6;
};

}  // namespace morphbake
