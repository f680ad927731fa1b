#pragma once

#include <Eigen/Geometry>

namespace morphbake {

/// Most rotations are small, and functions of the C library take longer than all else that is done
/// with them: below these squares power series are as exact. For numbers, and for several at once.
namespace half_angle_series {

inline constexpr double kLargest = 0.16;      ///< x^2 of sine() and cosine()
inline constexpr double kLargestSine = 0.01;  ///< s^2 of arc()

/// asin(s) / s of s^2.
template <class Number>
[[gnu::always_inline]] inline Number arc(const Number& square) {
  Number sum = 231.0 / 13312 * square + 63.0 / 2816;
  sum = sum * square + 35.0 / 1152;
  sum = sum * square + 5.0 / 112;
  sum = sum * square + 3.0 / 40;
  sum = sum * square + 1.0 / 6;
  return sum * square + 1.0;
}

/// sin(x) / x of x^2.
template <class Number>
[[gnu::always_inline]] inline Number sine(const Number& square) {
  Number sum = 1.0 / 6227020800 * square - 1.0 / 39916800;
  sum = sum * square + 1.0 / 362880;
  sum = sum * square - 1.0 / 5040;
  sum = sum * square + 1.0 / 120;
  sum = sum * square - 1.0 / 6;
  return sum * square + 1.0;
}

/// cos(x) of x^2.
template <class Number>
[[gnu::always_inline]] inline Number cosine(const Number& square) {
  Number sum = 1.0 / 479001600 * square - 1.0 / 3628800;
  sum = sum * square + 1.0 / 40320;
  sum = sum * square - 1.0 / 720;
  sum = sum * square + 1.0 / 24;
  sum = sum * square - 0.5;
  return sum * square + 1.0;
}

}  // namespace half_angle_series

/// Axis times angle of a rotation, the shorter way: at most pi long.
Eigen::Vector3d rotation_vector(const Eigen::Quaterniond& rotation);

/// The rotation about `vector` by its length in radians.
Eigen::Quaterniond rotation_of(const Eigen::Vector3d& vector);

/// The rotation R nearest to a matrix: matrix = R S with a symmetric S, which mirrors if it does.
Eigen::Matrix3d nearest_rotation(const Eigen::Matrix3d& matrix);

}  // namespace morphbake
