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
  double time = 0;          ///< seconds of the animation
};

/// The seconds of an animation that a loop plays.
struct PlayedSpan {
  double begin = 0;  ///< the first key's
  double end = 0;    ///< the last key's
  /// Plays to the end and back; otherwise straight through, for the last key's weights are the
  /// first's.
  bool returns = false;
};

PlayedSpan played_span(const AnimatedMesh& mesh);

/// What several animations play on one clock: from the first key of any to the last; straight
/// through only when all may.
///
/// @param spans  one or more
PlayedSpan common_span(const std::vector<PlayedSpan>& spans);

/// Seconds at `phase` (0 to 1) of the loop.
double time_at(const PlayedSpan& span, double phase);

/// Camera azimuth in degrees at `phase` (0 to 1) of the loop.
///
/// A whole number of turns goes round evenly; any other `orbit` would jump at the end, so the
/// camera swings by half of it to either side.
double orbit_azimuth(const TurntableOptions& options, double phase);

/// The loop's moments in order; the first follows the last as any other follows its neighbour.
///
/// Beyond the keys of `mesh` its first and last pose stand.
std::vector<LoopMoment> loop_moments(const AnimatedMesh& mesh, const PlayedSpan& span,
                                     const TurntableOptions& options);

}  // namespace morphbake
