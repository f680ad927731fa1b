// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "mesh.h"
#include "solid.h"

namespace shapes {

/// Meshes the surface of the solid, finer where its parts ask for detail.
///
/// Delaunay refinement (CGAL Mesh_3), then tangential relaxation with projection back onto the
/// surface. With `cut_z` the part in front of that plane, with one smooth boundary loop on it.
/// @see Boissonnat and Oudot 2005, Provably good sampling and meshing of surfaces
Mesh mesh_surface(const Solid& solid);

enum class Topology { Sphere, Disk };

/// @throws std::runtime_error when the mesh is not what its name promises: manifold, in one piece,
/// of the given topology, each vertex used, free of self-intersections.
void check(const Mesh& mesh, const std::string& name, Topology topology);

/// A place on the surface that outlives a change of the geometry.
struct SurfacePoint {
  int triangle;
  Vector barycentric;
};

/// Closest points of the surface, one for each given point.
std::vector<SurfacePoint> closest(const Mesh& mesh, const std::vector<Vector>& points);

}  // namespace shapes
