#pragma once

#include <Eigen/Geometry>

namespace morphbake {

/// Axis times angle of a rotation, the shorter way: at most pi long.
Eigen::Vector3d rotation_vector(const Eigen::Quaterniond& rotation);

/// The rotation about `vector` by its length in radians.
Eigen::Quaterniond rotation_of(const Eigen::Vector3d& vector);

/// The rotation R nearest to a matrix: matrix = R S with a symmetric S, which mirrors if it does.
Eigen::Matrix3d nearest_rotation(const Eigen::Matrix3d& matrix);

}  // namespace morphbake
