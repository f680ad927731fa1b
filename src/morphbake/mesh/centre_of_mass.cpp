#include "morphbake/mesh/centre_of_mass.h"

#include "morphbake/mesh/measures.h"

namespace morphbake {

Eigen::Vector3d centre_of_mass(const Positions& positions, const Triangles& triangles) {
  if (positions.rows() == 0) return Eigen::Vector3d::Zero();
  // A third of each triangle's area at each corner has the same centre.
  Eigen::VectorXd weights = vertex_areas(positions, triangles);
  if (!(weights.sum() > 0)) weights.setOnes(positions.rows());
  weights /= weights.sum();
  return positions.transpose() * weights;
}

}  // namespace morphbake
