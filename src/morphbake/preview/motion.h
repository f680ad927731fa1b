#pragma once

#include <Eigen/Core>
#include <vector>

#include "morphbake/gltf/animated_mesh.h"
#include "morphbake/preview/turntable.h"

namespace morphbake {

/// What one picture of the loop shows.
struct LoopMoment {
  Eigen::VectorXd weights;  ///< one a target
  double azimuth = 0;       ///< radians
};

/// Share of the animation's length that is shown at `phase` (0 to 1) of the loop: up to the end and
/// back, or straight through when the last key's weights are the first's.
double played_share(const AnimatedMesh& mesh, double phase);

/// Camera azimuth in degrees at `phase` (0 to 1) of the loop.
///
/// A whole number of turns goes round evenly; any other `orbit` would jump at the end, so the
/// camera swings by half of it to either side.
double orbit_azimuth(const TurntableOptions& options, double phase);

/// The loop's moments in order; the first follows the last as any other follows its neighbour.
std::vector<LoopMoment> loop_moments(const AnimatedMesh& mesh, const TurntableOptions& options);

}  // namespace morphbake
