#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "morphbake/export/mesh_morph.h"

namespace morphbake {
namespace {

/// Angle in degrees; atan2 keeps its digits where acos loses them.
double angle_between(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return std::atan2(a.cross(b).norm(), a.dot(b)) * 180 / std::numbers::pi;
}

/// Base plus weighted targets of one attribute, in double from the written floats.
Positions evaluate(const Float3s& base, const std::vector<Float3s>& targets,
                   const Eigen::VectorXd& weights) {
  Positions rows = base.cast<double>();
  for (std::size_t k = 0; k < targets.size(); ++k) {
    const double weight = weights(static_cast<Eigen::Index>(k));
    if (weight != 0) rows += weight * targets[k].cast<double>();
  }
  return rows;
}

std::vector<double> frames_and_middles(const std::vector<double>& frame_times) {
  std::vector<double> times;
  for (std::size_t f = 0; f < frame_times.size(); ++f) {
    if (f > 0) times.push_back((frame_times[f - 1] + frame_times[f]) / 2);
    times.push_back(frame_times[f]);
  }
  return times;
}

}  // namespace

MorphError measure_mesh_morph(const SourceMesh& first, const MorphableMesh& mesh,
                              const MeshMorph& written, const SmoothingGroups& groups,
                              const ReferenceMotion& motion) {
  const Eigen::Matrix3d linear = first.geometry.to_scene.topLeftCorner<3, 3>();
  const Eigen::RowVector3d translation = first.geometry.to_scene.topRightCorner<3, 1>().transpose();
  const Eigen::Matrix3d inverse = linear.inverse();
  MorphError error;
  for (const double time : frames_and_middles(motion.frame_times)) {
    const Positions expected = motion.positions_at(time);
    const Eigen::VectorXd w = interpolate_keys(written.key_times, written.key_weights, time);
    Normals expected_normals;
    if (groups.count > 0) expected_normals = deformed_normals(groups, mesh, expected);
    std::size_t render = 0;
    for (const PrimitiveMorph& primitive : written.primitives) {
      const Positions positions = evaluate(primitive.positions, primitive.target_positions, w);
      const Positions normals = evaluate(primitive.normals, primitive.target_normals, w);
      for (Eigen::Index r = 0; r < positions.rows(); ++r, ++render) {
        const int vertex = mesh.vertex_of_render[render];
        if (vertex < 0) continue;
        const Eigen::RowVector3d at = positions.row(r) * linear.transpose() + translation;
        error.distance = std::max(error.distance, (at - expected.row(vertex)).norm());
        if (groups.count == 0) continue;
        const Eigen::Vector3d normal = (normals.row(r) * inverse).transpose();
        const double angle = angle_between(normal, expected_normals.row(groups.of_render[render]));
        if (angle > error.normal_angle) {
          error.normal_angle = angle;
          error.normal_time = time;
          error.normal_vertex = vertex;
        }
      }
    }
  }
  return error;
}

}  // namespace morphbake
