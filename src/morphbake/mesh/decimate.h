#pragma once

#include "morphbake/mesh/mesh.h"

namespace morphbake {

/// A coarser copy of a manifold mesh, of about `vertices` vertices at most.
///
/// Edges are collapsed where that changes the surface least, so tips stay. Meshes that are coarse
/// enough come back as they are.
/// @cost  about 5 us a vertex that goes
/// @see   Garland and Heckbert 1997; CGAL Surface_mesh_simplification
Mesh decimated(const Mesh& mesh, int vertices);

}  // namespace morphbake
