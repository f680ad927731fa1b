#pragma once

#include <vector>

#include "morphbake/diagnostics/observer.h"
#include "morphbake/gltf/animated_mesh.h"
#include "morphbake/images/images.h"
#include "morphbake/mesh/mesh.h"
#include "morphbake/preview/turntable.h"

namespace morphbake {

/// Where a point of the scene is in a picture.
struct SeenPoint {
  Eigen::Vector2f pixel = {0, 0};  ///< from the top left corner
  bool is_hidden = false;          ///< behind the shape
};

struct StillView {
  Image picture;
  std::vector<SeenPoint> points;
};

/// A picture of the mesh at rest, and where points of its surface are seen in it.
///
/// Warns of textures as make_appearance.
/// @param options  azimuth and elevation say from where; one frame
/// @param points   scene coordinates
/// @throws BakeError "preview.not-finite"
StillView render_still(const AnimatedMesh& mesh, const TurntableOptions& options,
                       const Positions& points, const Observer& observer = {});

}  // namespace morphbake
