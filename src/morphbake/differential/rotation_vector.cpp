#include "morphbake/differential/rotation_vector.h"

#include <Eigen/LU>
#include <Eigen/SVD>
#include <cmath>

namespace morphbake {

Eigen::Vector3d rotation_vector(const Eigen::Quaterniond& rotation) {
  const double sign = rotation.w() < 0 ? -1 : 1;
  const double square = rotation.vec().squaredNorm();
  if (square < half_angle_series::kLargestSine) {
    return 2 * sign * half_angle_series::arc(square) * rotation.vec();
  }
  const double sine = std::sqrt(square);
  return 2 * sign * std::atan2(sine, sign * rotation.w()) / sine * rotation.vec();
}

Eigen::Quaterniond rotation_of(const Eigen::Vector3d& vector) {
  const double square = vector.squaredNorm() / 4;  // of half the angle
  Eigen::Quaterniond rotation;
  if (square < half_angle_series::kLargest) {
    rotation.w() = half_angle_series::cosine(square);
    rotation.vec() = half_angle_series::sine(square) / 2 * vector;
    return rotation;
  }
  const double half = std::sqrt(square);
  rotation.w() = std::cos(half);
  rotation.vec() = std::sin(half) / half / 2 * vector;
  return rotation;
}

Eigen::Matrix3d nearest_rotation(const Eigen::Matrix3d& matrix) {
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(matrix, Eigen::ComputeFullU | Eigen::ComputeFullV);
  Eigen::Matrix3d U = svd.matrixU();
  if ((U * svd.matrixV().transpose()).determinant() < 0) U.col(2) *= -1;
  return U * svd.matrixV().transpose();
}

}  // namespace morphbake
