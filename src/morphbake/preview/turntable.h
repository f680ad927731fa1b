#pragma once

#include <Eigen/Core>
#include <vector>

#include "morphbake/diagnostics/observer.h"
#include "morphbake/gltf/animated_mesh.h"
#include "morphbake/images/images.h"

namespace morphbake {

/// How a turntable looks. Defaults stand in config/preview.json too.
struct TurntableOptions {
  int width = 512;        ///< pixels, 16 to 4096
  int height = 512;       ///< pixels, 16 to 4096
  int frames = 72;        ///< pictures in the loop, 1 to 10000
  int samples = 8;        ///< camera rays a pixel, 1 to 1024; more is smoother and slower
  double orbit = 360;     ///< degrees, -3600 to 3600: see orbit_azimuth; 0 keeps the camera still
  double azimuth = 30;    ///< degrees of the first picture, 0 looks at the front (+Z)
  double elevation = 12;  ///< degrees above the horizon, -80 to 80
  double field_of_view = 24;  ///< degrees from top to bottom, 2 to 90; smaller is flatter
  double fill =
      0.75;  ///< share of the picture that the subject's larger side takes at most, 0.6 to 0.85
  bool floor_follows =
      true;  ///< the floor touches the lowest point of each pose, not of the whole motion
  Eigen::Vector3f background = {0.925f, 0.92f, 0.91f};  ///< sRGB of the backdrop's middle, 0 to 1
  int threads = 0;                                      ///< 0: all cores. Never changes a pixel.
};

/// Renders a loop: the camera orbits while the morph plays to its end and back (or once, when its
/// last pose is its first).
///
/// Base colour, soft studio light, ambient occlusion, ground shadow; a surface without any colour
/// gets that of clay. The camera keeps its distance and the subject is never cut over the whole
/// motion.
/// @return  `options.frames` pictures; the same bytes whatever the number of threads
/// @throws BakeError "preview.bad-option", "preview.not-finite" (a vertex of some pose),
/// "image...." as
///         decode_image; Cancelled between two pictures
/// @cost    one ray a sample and pixel, two more where it meets the subject or the floor nearby;
/// memory
///          for all pictures and about 120 bytes a pixel
std::vector<Image> render_turntable(const AnimatedMesh& mesh, const TurntableOptions& options,
                                    const Observer& observer);

}  // namespace morphbake
