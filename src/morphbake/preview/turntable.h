#pragma once

#include <array>
#include <string>
#include <vector>

#include "morphbake/diagnostics/observer.h"
#include "morphbake/gltf/animated_mesh.h"
#include "morphbake/images/images.h"

namespace morphbake {

/// How a turntable looks. Defaults stand in config/bake.json too.
struct TurntableOptions {
  int width = 512;   ///< pixels, 16 to 4096
  int height = 512;  ///< pixels, 16 to 4096
  int frames = 72;   ///< pictures in the loop, 1 to 10000
  int samples = 8;   ///< camera rays a pixel, 1 to 1024; more is smoother and slower

  /// Degrees that the camera turns over the loop, -3600 to 3600; 0 keeps it still. Whole turns go
  /// round evenly; any other value would jump at the end, so the camera swings by half of it to
  /// either side of `azimuth` and back.
  double orbit = 360;
  double azimuth = 30;        ///< degrees of the first picture, 0 looks at the front (+Z)
  double elevation = 12;      ///< degrees above the horizon, -80 to 80
  double field_of_view = 24;  ///< degrees from top to bottom, 2 to 90; smaller is flatter

  /// Share of the picture that the subject's larger side takes at most, 0.6 to 0.85.
  double fill = 0.75;

  /// Whether the floor touches the lowest point of each pose (morphs that grow both ways stay on
  /// it) or lies still below the whole motion (jumps are seen).
  bool floor_follows = true;

  std::array<double, 3> background = {0.925, 0.92,
                                      0.91};  ///< sRGB of the backdrop's middle, 0 to 1
  int threads = 0;                            ///< 0: all cores. Never changes a pixel.
};

/// Renders a loop: the camera orbits while the morph plays to its end and back (or once, when its
/// last pose is its first).
///
/// Base colour, soft studio light, ambient occlusion, ground shadow; a surface without any colour
/// gets that of clay. The camera keeps its distance and the subject is never cut over the whole
/// motion. Warns of textures as make_appearance.
/// @return  `options.frames` pictures; the same bytes whatever the number of threads
/// @throws BakeError "preview.bad-option"; "preview.not-finite" (a vertex of some pose); Cancelled
///         between two pictures
/// @cost    one ray a sample and pixel, two more where it meets the subject or the floor nearby;
///          memory for all pictures and about 120 bytes a pixel
std::vector<Image> render_turntable(const AnimatedMesh& mesh, const TurntableOptions& options,
                                    const Observer& observer);

/// A morph that is shown beside others.
struct TurntableSubject {
  std::string file;   ///< for messages
  std::string label;  ///< what stands above it
  AnimatedMesh mesh;
};

/// Renders several morphs beside one another in the order given, each under its label: one camera,
/// one scale, one clock. Those whose animation is over stay at its end.
///
/// Meshes are moved once so that their first moments stand over one point of one ground.
/// @param subjects  one or more
/// @param options   width and height of the picture of one of them
/// @return          `options.frames` pictures of one size, the seconds in a corner
/// @throws BakeError as render_turntable
/// @cost    as render_turntable, once a subject
std::vector<Image> render_side_by_side(const std::vector<TurntableSubject>& subjects,
                                       const TurntableOptions& options, const Observer& observer);

}  // namespace morphbake
