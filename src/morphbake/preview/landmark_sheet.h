#pragma once

#include <string>
#include <vector>

#include "morphbake/diagnostics/observer.h"
#include "morphbake/gltf/animated_mesh.h"
#include "morphbake/images/images.h"
#include "morphbake/mesh/mesh.h"

namespace morphbake {

/// A shape with points on it.
struct MarkedShape {
  std::string title;
  AnimatedMesh mesh;
  Positions marks;  ///< scene coordinates, one a name of the sheet
};

struct LandmarkSheetOptions {
  int view_size = 480;  ///< pixels of a picture's side, 64 to 2048
  int samples = 8;      ///< camera rays a pixel
  int threads = 0;      ///< 0: all cores; never changes a pixel
};

/// Front, left, back and top of each shape with numbered dots, and a legend of their names.
///
/// Dots that the shape hides are faint rings. Equal numbers have equal colours on all shapes.
/// @throws BakeError "preview.not-finite"; what decode_image throws; Cancelled
Image render_landmark_sheet(const std::vector<MarkedShape>& shapes,
                            const std::vector<std::string>& names,
                            const LandmarkSheetOptions& options, const Observer& observer);

}  // namespace morphbake
