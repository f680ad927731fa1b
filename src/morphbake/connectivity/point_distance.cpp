#include "morphbake/connectivity/point_distance.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>

// CGAL::squared_distance(Point_3, Triangle_3) on Simple_cartesian<double> took 2.4 times as long
// and divides by zero on needles.

namespace morphbake {

using Eigen::Vector3d;

double point_segment_distance(const Vector3d& point, const Vector3d& a, const Vector3d& b) {
  const Vector3d ab = b - a;
  const double squared = ab.squaredNorm();
  const double t = squared > 0 ? std::clamp((point - a).dot(ab) / squared, 0.0, 1.0) : 0;
  return (point - a - t * ab).norm();
}

double point_triangle_distance(const Vector3d& point, const Vector3d& a, const Vector3d& b,
                               const Vector3d& c) {
  const Vector3d normal = (b - a).cross(c - a);
  const double squared = normal.squaredNorm();
  // Above the triangle itself the plane is nearest, else one of the sides.
  const bool is_above = squared > 0 && (b - a).cross(point - a).dot(normal) >= 0 &&
                        (c - b).cross(point - b).dot(normal) >= 0 &&
                        (a - c).cross(point - c).dot(normal) >= 0;
  if (is_above) return std::abs((point - a).dot(normal)) / std::sqrt(squared);
  return std::min({point_segment_distance(point, a, b), point_segment_distance(point, b, c),
                   point_segment_distance(point, c, a)});
}

}  // namespace morphbake
