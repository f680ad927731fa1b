#pragma once

#include <Eigen/Geometry>

namespace morphbake {

/// Axis times angle of a rotation, the shorter way: at most pi long.
Eigen::Vector3d rotation_vector(const Eigen::Quaterniond& rotation);

/// The rotation about `vector` by its length in radians.
Eigen::Quaterniond rotation_of(const Eigen::Vector3d& vector);

}  // namespace morphbake
