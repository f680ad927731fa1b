#include "morphbake/correspondence/triangle_energy.h"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace morphbake {
namespace {

using Eigen::Vector3d;

double dirichlet(const RestTriangle& rest, const Vector3d& a, const Vector3d& b,
                 const Vector3d& c) {
  return 0.5 *
         (rest.cotangents(0) * (b - c).squaredNorm() + rest.cotangents(1) * (c - a).squaredNorm() +
          rest.cotangents(2) * (a - b).squaredNorm());
}

/// Twice the area that enters an energy, and its derivative by the first corner.
struct TwiceArea {
  double value = 0;
  Vector3d derivative;
};

TwiceArea seen_area(const SurfaceTriangle& triangle, const Vector3d& a, const Vector3d& b,
                    const Vector3d& c) {
  const double s = triangle.normal.dot((b - a).cross(c - a));
  const double root = std::sqrt(s * s + 4 * triangle.slack * triangle.slack);
  return {0.5 * (s + root), 0.5 * (1 + s / root) * (b - c).cross(triangle.normal)};
}

/// Q (1 + 4 A^2 / d^2) and its derivatives; that d is not quite linear in `a` is left out of the
/// Hessian.
void add_energy(const RestTriangle& rest, const std::array<Vector3d, 3>& corners,
                const TwiceArea& twice_area, double weight, CornerEnergy& sum) {
  const auto& [a, b, c] = corners;
  const double q = weight * dirichlet(rest, a, b, c);
  const auto& [d, dd] = twice_area;
  const Vector3d dq = weight * (rest.cotangents(1) * (a - c) + rest.cotangents(2) * (a - b));
  const double ddq = weight * (rest.cotangents(1) + rest.cotangents(2));
  const double r = 4 * rest.area * rest.area / (d * d);
  sum.energy += q * (1 + r);
  sum.gradient += (1 + r) * dq - (2 * q * r / d) * dd;
  const Eigen::Matrix3d mixed = dq * dd.transpose();
  sum.hessian += ddq * (1 + r) * Eigen::Matrix3d::Identity() -
                 (2 * r / d) * (mixed + mixed.transpose()) +
                 (6 * q * r / (d * d)) * (dd * dd.transpose());
}

/// A triangle on its longest edge: the foot of the height is `along` from the corner that follows
/// the top one.
struct OnLongestEdge {
  int top = 0;
  double longest = 0;
  double along = 0;
  double height = 0;
};

RestTriangle rest_on(const OnLongestEdge& triangle, double area_scale, double least_area) {
  const auto& [k, longest, along, height] = triangle;
  RestTriangle rest;
  rest.cotangents((k + 1) % 3) = along / height;
  rest.cotangents((k + 2) % 3) = (longest - along) / height;
  rest.cotangents(k) = (height * height - along * (longest - along)) / (longest * height);
  rest.area = std::max(0.5 * longest * height * area_scale, least_area);
  return rest;
}

}  // namespace

RestTriangle rest_triangle(const Vector3d& a, const Vector3d& b, const Vector3d& c,
                           double area_scale, const RestLimits& limits) {
  const std::array<const Vector3d*, 3> p{&a, &b, &c};
  std::size_t k = 0;  // the corner opposite the longest edge
  double longest = -1;
  for (std::size_t i = 0; i < 3; ++i) {
    const double length = (*p[(i + 2) % 3] - *p[(i + 1) % 3]).squaredNorm();
    if (length > longest) {
      longest = length;
      k = i;
    }
  }
  longest = std::max(std::sqrt(longest), 1e-12);
  const Vector3d base = *p[(k + 2) % 3] - *p[(k + 1) % 3];
  const Vector3d side = *p[k] - *p[(k + 1) % 3];
  const double height = std::max(base.cross(side).norm() / longest, limits.height * longest);
  const double along = std::clamp(side.dot(base) / longest, 0.0, longest);
  return rest_on({static_cast<int>(k), longest, along, height}, area_scale, limits.area);
}

double sphere_energy(const RestTriangle& rest, const Vector3d& a, const Vector3d& b,
                     const Vector3d& c) {
  const double d = determinant(a, b, c);
  if (!(d > 1e-150)) return std::numeric_limits<double>::infinity();
  const double r = 2 * rest.area / d;
  return dirichlet(rest, a, b, c) * (1 + r * r);
}

void add_sphere_energy(const RestTriangle& rest, const Vector3d& a, const Vector3d& b,
                       const Vector3d& c, CornerEnergy& sum) {
  add_energy(rest, {a, b, c}, {determinant(a, b, c), b.cross(c - b)}, 1, sum);
}

RestTriangle rest_triangle(const Vector3d& squared_lengths, const RestLimits& limits) {
  int k = 0;
  const double longest = std::sqrt(std::max(squared_lengths.maxCoeff(&k), 1e-24));
  // The corner opposite the longest edge stands at `along` from the corner that follows it.
  const double to_next = squared_lengths((k + 2) % 3), to_last = squared_lengths((k + 1) % 3);
  const double along =
      std::clamp((to_next + longest * longest - to_last) / (2 * longest), 0.0, longest);
  const double height = std::sqrt(std::max(0.0, to_next - along * along));
  return rest_on({k, longest, along, std::max(height, limits.height * longest)}, 1, limits.area);
}

double surface_energy(const SurfaceTriangle& triangle, const Vector3d& a, const Vector3d& b,
                      const Vector3d& c) {
  const double r = 2 * triangle.rest.area / seen_area(triangle, a, b, c).value;
  return dirichlet(triangle.rest, a, b, c) * (1 + r * r);
}

void add_surface_energy(const SurfaceTriangle& triangle, const std::array<Vector3d, 3>& corners,
                        double weight, CornerEnergy& sum) {
  const auto& [a, b, c] = corners;
  add_energy(triangle.rest, corners, seen_area(triangle, a, b, c), weight, sum);
}

TangentAxes tangent_axes(const Vector3d& p) {
  const Vector3d aside = std::abs(p.x()) < 0.8 ? Vector3d::UnitX() : Vector3d::UnitY();
  const Vector3d a = aside.cross(p).normalized();
  return {a, p.cross(a)};
}

Eigen::Vector2d newton_step(const Eigen::Vector2d& gradient, const Eigen::Matrix2d& hessian) {
  // Eigenvalues of [[m + d, o], [o, m - d]] are m +- r; made positive and bounded away from zero.
  const double m = 0.5 * (hessian(0, 0) + hessian(1, 1));
  const double d = 0.5 * (hessian(0, 0) - hessian(1, 1)), o = hessian(0, 1);
  const double r = std::hypot(d, o);
  const double largest = std::max(std::abs(m + r), std::abs(m - r));
  if (!(largest > 0) || !std::isfinite(largest)) return Eigen::Vector2d::Zero();
  const double first = std::max(std::abs(m + r), 1e-4 * largest);
  const double second = std::max(std::abs(m - r), 1e-4 * largest);
  // The eigenvector of m + r, by half the angle of (d, o).
  const double angle = 0.5 * std::atan2(o, d);
  const Eigen::Vector2d e(std::cos(angle), std::sin(angle)), f(-e.y(), e.x());
  return -(e * (e.dot(gradient) / first) + f * (f.dot(gradient) / second));
}

}  // namespace morphbake
