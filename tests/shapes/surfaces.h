#pragma once

#include <string>
#include <vector>

#include "morphbake/sources/source_surface.h"
#include "shapes/shapes.h"

namespace morphbake::test {

/// The triangle whose middle lies furthest in a direction, with unequal weights: inside of it.
inline SurfacePoint furthest(const Mesh& mesh, const Eigen::Vector3d& direction) {
  SurfacePoint point;
  double best = -1e300;
  for (int f = 0; f < mesh.triangles.rows(); ++f) {
    double along = 0;
    for (int k = 0; k < 3; ++k) along += mesh.positions.row(mesh.triangles(f, k)).dot(direction);
    if (along <= best) continue;
    best = along;
    point = {f, {0.5, 0.3, 0.2}};
  }
  return point;
}

/// A closed source with landmarks inside the triangles that lie furthest in the directions.
inline SourceSurface surface(const std::string& name, const Mesh& mesh,
                             const std::vector<Eigen::Vector3d>& directions) {
  SourceSurface source;
  source.name = source.file = name;
  source.mesh = mesh;
  for (const Eigen::Vector3d& direction : directions) {
    source.landmark_names.push_back("point " + std::to_string(source.landmarks.size()));
    source.landmarks.push_back(furthest(mesh, direction));
  }
  return source;
}

inline const std::vector<Eigen::Vector3d> kAxes{
    {1, 0.1, 0.2}, {-0.2, 1, 0.1}, {0.1, 0.2, 1}, {-1, 0.2, -0.1}};

/// An even sphere and a finer one that is bent and longer.
inline std::vector<SourceSurface> two_spheres() {
  Mesh bent = sphere(17, 23);
  bent.positions = test::bent(bent.positions, 0.2, 7);
  bent.positions.col(1) *= 1.5;
  return {surface("even", sphere(12, 16), kAxes), surface("bent", bent, kAxes)};
}

}  // namespace morphbake::test
