#pragma once

#include <vector>

#include "morphbake/diagnostics/observer.h"
#include "morphbake/gltf/animated_mesh.h"
#include "morphbake/images/images.h"

namespace morphbake {

/// How a turntable looks. Defaults stand in config/preview.json too.
struct TurntableOptions {
  int width = 512;       ///< pixels, 16 to 4096
  int height = 512;      ///< pixels, 16 to 4096
  int frames = 72;       ///< pictures in the loop, 1 to 10000
  int samples = 16;      ///< rays a pixel, 1 to 1024; more is smoother and slower
  double orbit = 360;    ///< degrees the camera turns over the loop; 0 keeps it still
  double azimuth = 30;   ///< degrees of the first picture, 0 looks at the front (+Z)
  double elevation = 12; ///< degrees above the horizon, -80 to 80
  double fill = 0.75;    ///< share of the picture that the subject's larger side takes at most, 0.6 to 0.85
  int threads = 0;       ///< 0: all cores. Never changes a pixel.
};

/// Renders a loop: the camera orbits while the morph plays to its end and back (or once, when its last
/// pose is its first).
///
/// Base colour, soft studio light, ambient occlusion, ground shadow. The subject is never cut over the
/// whole motion.
/// @return  `options.frames` pictures; the same bytes whatever the number of threads
std::vector<Image> render_turntable(const AnimatedMesh& mesh, const TurntableOptions& options,
                                    const Observer& observer);

}  // namespace morphbake
