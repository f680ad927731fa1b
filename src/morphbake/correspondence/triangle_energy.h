#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>

namespace morphbake {

/// The undeformed shape of a triangle, as its energy needs it.
struct RestTriangle {
  Eigen::Vector3d cotangents = Eigen::Vector3d::Zero();  ///< of the corners' angles
  double area = 0;
};

/// How far needles are fattened, so that cotangents stay finite.
struct RestLimits {
  double height = 0.05;  ///< least height over the longest edge, as a fraction of it
  double area = 1e-9;    ///< least area after scaling
};

/// @param area_scale  factor on the area
RestTriangle rest_triangle(const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                           const Eigen::Vector3d& c, double area_scale, const RestLimits& limits);

/// Six times the volume of the tetrahedron (0, a, b, c); positive when the triangle is
/// counter-clockwise seen from outside the sphere. Differences first: they are exact for
/// neighbours.
inline double determinant(const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                          const Eigen::Vector3d& c) {
  return a.dot((b - a).cross(c - a));
}

/// Whether (a, b, c) is counter-clockwise on the sphere by more than rounding can pretend.
///
/// Relative to the edges: absolute bounds would refuse to refine limbs that the map has made small.
/// What passes also passes CGAL's exact predicate.
inline bool is_positive(const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                        const Eigen::Vector3d& c) {
  const Eigen::Vector3d ab = b - a, ac = c - a;
  return a.dot(ab.cross(ac)) > 1e-10 * ab.norm() * ac.norm();
}

/// Energy with its derivatives by the first corner.
struct CornerEnergy {
  double energy = 0;
  Eigen::Vector3d gradient = Eigen::Vector3d::Zero();
  Eigen::Matrix3d hessian = Eigen::Matrix3d::Zero();
};

/// Symmetric Dirichlet energy of the map from a rest triangle to (a, b, c) on the unit sphere.
///
/// E = Q (1 + 4 A^2 / D^2) with the Dirichlet energy Q and the determinant D in place of twice the
/// chord area: D also falls to 0 for a triangle that becomes a great circle, so E bars turned
/// triangles at every size. Infinite unless D > 0.
/// @return  4 A for an isometry of a small triangle
double sphere_energy(const RestTriangle& rest, const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                     const Eigen::Vector3d& c);

/// Adds the energy and its derivatives by `a`; (a, b, c) must be positive.
void add_sphere_energy(const RestTriangle& rest, const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                       const Eigen::Vector3d& c, CornerEnergy& sum);

/// The rest shape whose squared edge lengths are given, edge k opposite corner k: for means of
/// metrics.
RestTriangle rest_triangle(const Eigen::Vector3d& squared_lengths, const RestLimits& limits);

/// A triangle on a surface in space: what its energy needs besides its corners.
struct SurfaceTriangle {
  RestTriangle rest;
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();  ///< unit, of the surface below
  double slack = 0;  ///< twice the area that a triangle keeps in the energy when it stands up; a
                     ///< part of its present size, for against a fixed size it could vanish freely
};

/// Symmetric Dirichlet energy of the map from a rest triangle to (a, b, c) in space, whose area is
/// what a surface with this unit normal sees of it.
///
/// E = Q (1 + 4 A^2 / x(s)^2), s = normal . (b - a) x (c - a), x(s) = (s + sqrt(s^2 + 4 slack^2)) /
/// 2: a triangle that lies flat on the surface has the usual energy, one that stands up or is
/// folded over has much, but finite energy, which leads it back.
/// @see Garanzha et al. 2021 (foldover-free maps) for x(s)
double surface_energy(const SurfaceTriangle& triangle, const Eigen::Vector3d& a,
                      const Eigen::Vector3d& b, const Eigen::Vector3d& c);

/// Adds `weight` times the energy and its derivatives by `a`.
void add_surface_energy(const SurfaceTriangle& triangle,
                        const std::array<Eigen::Vector3d, 3>& corners, double weight,
                        CornerEnergy& sum);

/// Two unit vectors perpendicular to `p` (of unit length) and each other; (a, b, p) is
/// right-handed.
struct TangentAxes {
  Eigen::Vector3d a;
  Eigen::Vector3d b;
};

TangentAxes tangent_axes(const Eigen::Vector3d& p);

/// The step that minimises the quadratic model of a function of two variables, made convex.
///
/// @return  zero when there is nothing to gain
Eigen::Vector2d newton_step(const Eigen::Vector2d& gradient, const Eigen::Matrix2d& hessian);

}  // namespace morphbake
