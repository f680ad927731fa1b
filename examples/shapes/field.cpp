// SPDX-License-Identifier: GPL-3.0-or-later
#include "field.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

namespace shapes {
namespace {

const Vector mirror_x(-1, 1, 1);

Eigen::Matrix3d rotation(const Turn& turn) {
  constexpr double degree = std::numbers::pi / 180;
  return (Eigen::AngleAxisd(turn.about_y * degree, Vector::UnitY()) *
          Eigen::AngleAxisd(turn.about_x * degree, Vector::UnitX()) *
          Eigen::AngleAxisd(turn.about_z * degree, Vector::UnitZ()))
      .toRotationMatrix();
}

/// The shell is a line in the half-plane through the axis; left and right of it the end balls rule.
double limb_distance(const Limb& limb, const Vector& p) {
  const Vector axis = limb.to - limb.from;
  const Vector offset = p - limb.from;
  const double length2 = axis.squaredNorm();
  const double shrink = limb.from_radius - limb.to_radius;
  const double slope2 = length2 - shrink * shrink;
  if (slope2 <= 0) throw std::logic_error("limb: one end ball contains the other");
  const double along = offset.dot(axis);
  const double beyond = along - length2;
  const double across2 = (offset * length2 - axis * along).squaredNorm();
  const double far2 = beyond * beyond * length2;
  const double near2 = along * along * length2;
  const double edge = std::copysign(shrink * shrink * across2, shrink);
  if (std::copysign(slope2 * far2, beyond) > edge)
    return std::sqrt(across2 + far2) / length2 - limb.to_radius;
  if (std::copysign(slope2 * near2, along) < edge)
    return std::sqrt(across2 + near2) / length2 - limb.from_radius;
  return (std::sqrt(across2 * slope2 / length2) + along * shrink) / length2 - limb.from_radius;
}

double ball_distance(const Ball& ball, const Vector& p) {
  const Vector local = ball.axes.transpose() * (p - ball.centre);
  const double share = local.cwiseQuotient(ball.radii).norm();
  const double slope = local.cwiseQuotient(ball.radii.cwiseAbs2()).norm();
  if (slope == 0) return -ball.radii.minCoeff();
  return share * (share - 1) / slope;
}

}  // namespace

Form limb(const Vector& from, const Vector& to, double from_radius, double to_radius) {
  return Limb{from, to, from_radius, to_radius};
}

Form ball(const Vector& centre, const Vector& radii, const Turn& turn) {
  return Ball{centre, radii, rotation(turn)};
}

Form mirrored(const Form& form) {
  if (const auto* l = std::get_if<Limb>(&form))
    return Limb{l->from.cwiseProduct(mirror_x), l->to.cwiseProduct(mirror_x), l->from_radius,
                l->to_radius};
  const Ball& b = std::get<Ball>(form);
  return Ball{b.centre.cwiseProduct(mirror_x), b.radii, mirror_x.asDiagonal() * b.axes};
}

double distance(const Form& form, const Vector& p) {
  if (const auto* l = std::get_if<Limb>(&form)) return limb_distance(*l, p);
  return ball_distance(std::get<Ball>(form), p);
}

double smooth_min(double a, double b, double width) {
  if (width <= 0) return std::min(a, b);
  const double overlap = std::max(width - std::abs(a - b), 0.0) / width;
  return std::min(a, b) - overlap * overlap * overlap * width / 6;
}

}  // namespace shapes
