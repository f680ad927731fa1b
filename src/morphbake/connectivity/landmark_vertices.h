#pragma once

#include <Eigen/Core>
#include <vector>

#include "morphbake/sources/source_surface.h"

namespace morphbake {

/// A source's surface whose landmarks are vertices.
struct LandmarkedMesh {
  Mesh mesh;                                ///< the surface's own vertices first
  std::vector<int> landmarks;               ///< vertex of each landmark
  std::vector<Eigen::Vector2i> hard_edges;  ///< a < b, sorted
};

/// Makes the landmarks of `surface` vertices by splitting the triangle or edge in which they lie.
///
/// A landmark within 1e-9 (barycentric) of a vertex takes that vertex.
LandmarkedMesh insert_landmarks(const SourceSurface& surface);

}  // namespace morphbake
