#include "morphbake/correspondence/spherical_map.h"

namespace morphbake {

SurfacePoint point_on_source(const SphericalMap& map, int triangle,
                             const Eigen::Vector3d& weights) {
  SurfacePoint point;
  point.triangle = map.source_triangle[static_cast<std::size_t>(triangle)];
  point.barycentric.setZero();
  for (int corner = 0; corner < 3; ++corner) {
    const int v = map.surface.triangles(triangle, corner);
    const SurfacePoint& at = map.on_source[static_cast<std::size_t>(v)];
    // The corner may be noted in a neighbour, with which it then shares an edge or a vertex.
    for (int i = 0; i < 3; ++i) {
      for (int k = 0; k < 3; ++k) {
        if (map.source_triangles(at.triangle, i) != map.source_triangles(point.triangle, k))
          continue;
        point.barycentric(k) += weights(corner) * at.barycentric(i);
      }
    }
  }
  return point;
}

}  // namespace morphbake
