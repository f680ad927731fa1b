// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <variant>

namespace shapes {

using Vector = Eigen::Vector3d;

/// A cone with a ball at each end: legs, necks, tails.
struct Limb {
  Vector from, to;
  double from_radius, to_radius;  // metres
};

/// An ellipsoid: bodies, heads, ears.
struct Ball {
  Vector centre, radii;                                // metres
  Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();  // columns: the directions of the radii
};

using Form = std::variant<Limb, Ball>;

/// Degrees; turned about Z first, then X, then Y.
struct Turn {
  double about_x = 0, about_y = 0, about_z = 0;
};

Form limb(const Vector& from, const Vector& to, double from_radius, double to_radius);
Form ball(const Vector& centre, const Vector& radii, const Turn& turn = {});

/// The same form on the other side of the plane x = 0.
Form mirrored(const Form& form);

/// Distance from p to the surface of the form, negative inside. Exact for limbs; for balls exact to
/// first order near the surface, which is all that meshing needs.
double distance(const Form& form, const Vector& p);

/// Smallest of two distances with a crease rounded over the given width (twice differentiable).
double smooth_min(double a, double b, double width);

}  // namespace shapes
