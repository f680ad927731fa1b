#include "morphbake/differential/rotation_vector.h"

#include <cmath>

namespace morphbake {

Eigen::Vector3d rotation_vector(const Eigen::Quaterniond& rotation) {
  const double sign = rotation.w() < 0 ? -1 : 1;
  const double sine = rotation.vec().norm();
  // Below, sin x is x to the last bit.
  const double scale = sine < 1e-9 ? 2 : 2 * std::atan2(sine, sign * rotation.w()) / sine;
  return sign * scale * rotation.vec();
}

Eigen::Quaterniond rotation_of(const Eigen::Vector3d& vector) {
  const double angle = vector.norm();
  const double share = angle < 1e-9 ? 0.5 : std::sin(angle / 2) / angle;
  Eigen::Quaterniond rotation;
  rotation.w() = std::cos(angle / 2);
  rotation.vec() = share * vector;
  return rotation;
}

}  // namespace morphbake
