#pragma once

#include "morphbake/mesh/mesh.h"

namespace morphbake {

/// Centre of mass of a thin shell: triangles weighted by area; without any area, the mean of the
/// vertices. 0 for no vertices.
Eigen::Vector3d centre_of_mass(const Positions& positions, const Triangles& triangles);

}  // namespace morphbake
