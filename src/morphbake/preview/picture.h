#pragma once

#include <vector>

#include "morphbake/gltf/animated_mesh.h"
#include "morphbake/images/images.h"
#include "morphbake/preview/appearance.h"
#include "morphbake/preview/framing.h"
#include "morphbake/preview/pose.h"
#include "morphbake/preview/ray_scene.h"
#include "morphbake/preview/sampling.h"
#include "morphbake/preview/studio.h"

namespace morphbake {

/// All that one picture shows; the caller owns every part.
struct Scene {
  const AnimatedMesh& mesh;
  const std::vector<PosedPrimitive>& poses;  ///< in studio space
  const RayScene& rays;
  const Appearance& appearance;
  const Studio& studio;
  const Camera& camera;
  const SamplePattern& pattern;
  float floor = 0;  ///< height, studio units
};

/// Renders on all threads of the current task arena; they never change a pixel.
///
/// Colours are sampled in every pixel; the shares of the key light and of the room that are seen
/// from there are noisy and are averaged over the surface around (see filter_visibility).
Image render_picture(const Scene& scene, int width, int height);

}  // namespace morphbake
