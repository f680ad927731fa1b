#include "morphbake/differential/rotation_vector.h"

#include <Eigen/LU>
#include <Eigen/SVD>
#include <cmath>

namespace morphbake {
namespace {

// Most rotations are small, and functions of the C library take longer than all else that is done
// with them: below these squares power series are as exact.
constexpr double kSmallSine = 0.01;
constexpr double kSmallHalfAngle = 0.16;

/// asin(s) / s of s^2.
double arc_by_sine(double square) {
  constexpr double kTerms[] = {
      231.0 / 13312, 63.0 / 2816, 35.0 / 1152, 5.0 / 112, 3.0 / 40, 1.0 / 6, 1};
  double sum = 0;
  for (const double term : kTerms) sum = sum * square + term;
  return sum;
}

/// sin(x) / x of x^2.
double sine_by_angle(double square) {
  return 1 - square / 6 *
                 (1 - square / 20 *
                          (1 - square / 42 *
                                   (1 - square / 72 * (1 - square / 110 * (1 - square / 156)))));
}

/// cos(x) of x^2.
double cosine(double square) {
  return 1 - square / 2 *
                 (1 - square / 12 *
                          (1 - square / 30 *
                                   (1 - square / 56 * (1 - square / 90 * (1 - square / 132)))));
}

}  // namespace

Eigen::Vector3d rotation_vector(const Eigen::Quaterniond& rotation) {
  const double sign = rotation.w() < 0 ? -1 : 1;
  const double square = rotation.vec().squaredNorm();
  if (square < kSmallSine) return 2 * sign * arc_by_sine(square) * rotation.vec();
  const double sine = std::sqrt(square);
  return 2 * sign * std::atan2(sine, sign * rotation.w()) / sine * rotation.vec();
}

Eigen::Quaterniond rotation_of(const Eigen::Vector3d& vector) {
  const double square = vector.squaredNorm() / 4;  // of half the angle
  Eigen::Quaterniond rotation;
  if (square < kSmallHalfAngle) {
    rotation.w() = cosine(square);
    rotation.vec() = sine_by_angle(square) / 2 * vector;
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
