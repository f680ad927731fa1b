#include "morphbake/correspondence/check_map.h"

#ifdef __clang_analyzer__  // which mistakes how CGAL's exact numbers free their digits
#define CGAL_DO_NOT_USE_MPZF
#endif

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

namespace morphbake {

SphereCheck check_sphere(const Positions& sphere, const Triangles& triangles, bool is_half) {
  using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
  const auto point = [&](int v) {
    return Kernel::Point_3(sphere(v, 0), sphere(v, 1), sphere(v, 2));
  };
  SphereCheck check;
  for (Eigen::Index f = 0; f < triangles.rows(); ++f) {
    const int i = triangles(f, 0), j = triangles(f, 1), k = triangles(f, 2);
    // Seen from the centre a triangle that is counter-clockwise from outside runs clockwise.
    const auto turn = CGAL::orientation(point(i), point(j), point(k), Kernel::Point_3(0, 0, 0));
    check.turned += turn != CGAL::NEGATIVE;
    const Eigen::Vector3d a = sphere.row(i), b = sphere.row(j), c = sphere.row(k);
    // Van Oosterom and Strackee 1983.
    check.degree += 2 * std::atan2(a.dot((b - a).cross(c - a)), 1 + a.dot(b) + b.dot(c) + c.dot(a));
  }
  check.degree /= (is_half ? 2 : 4) * std::numbers::pi;
  return check;
}

}  // namespace morphbake
