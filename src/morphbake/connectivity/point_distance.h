#pragma once

#include <Eigen/Core>

namespace morphbake {

/// Distance of a point from a triangle.
double point_triangle_distance(const Eigen::Vector3d& point, const Eigen::Vector3d& a,
                               const Eigen::Vector3d& b, const Eigen::Vector3d& c);

/// Distance of a point from a segment.
double point_segment_distance(const Eigen::Vector3d& point, const Eigen::Vector3d& a,
                              const Eigen::Vector3d& b);

}  // namespace morphbake
