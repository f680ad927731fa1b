#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "morphbake/diagnostics/observer.h"
#include "morphbake/gltf/animated_mesh.h"
#include "morphbake/gltf/write_mesh.h"
#include "morphbake/preview/appearance.h"
#include "morphbake/sources/source_mesh.h"
#include "morphbake/sources/source_surface.h"

namespace morphbake {

/// The base colours of a source, ready to be looked up at points of its surface.
struct SurfaceColours {
  AnimatedMesh mesh;
  Appearance appearance;
  PlainMaterial material;      ///< of the first primitive
  std::vector<int> primitive;  ///< one a triangle of the surface
  std::vector<int> corners;    ///< 3 a triangle of the surface: vertex of its primitive
  std::vector<double> area;    ///< one a triangle, scene units squared

  /// Whether they differ from point to point.
  bool any() const;
};

/// Reads a source's colours and textures; warns of textures as make_appearance.
///
/// @throws BakeError "gltf...." as read_animated_mesh
SurfaceColours surface_colours(const SourceMesh& source, const SourceSurface& surface,
                               const Observer& observer);

/// Linear RGB in [0, 1]: base-colour texture times COLOR_0 times factor (glTF 2.0, 3.9.2).
///
/// @param width  of what is to show the colour, scene units: chooses the texture's level
Eigen::Array3f colour_at(const SurfaceColours& colours, const SurfacePoint& at, double width);

}  // namespace morphbake
