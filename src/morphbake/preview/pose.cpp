#include "morphbake/preview/pose.h"

#include <algorithm>

namespace morphbake {
namespace {

template <class Rows>
void add_targets(const std::vector<Float3s>& targets, const Eigen::VectorXd& weights, Rows&& rows) {
  const std::size_t count = std::min(targets.size(), static_cast<std::size_t>(weights.size()));
  for (std::size_t i = 0; i < count; ++i) {
    const float weight = static_cast<float>(weights[static_cast<Eigen::Index>(i)]);
    if (weight != 0.0f && targets[i].rows() > 0) rows += weight * targets[i];
  }
}

}  // namespace

void pose_primitive(const AnimatedPrimitive& primitive, const Eigen::VectorXd& weights,
                    const Eigen::Affine3d& transform, PosedPrimitive& pose) {
  const Eigen::Index count = primitive.positions.rows();
  pose.positions.resize(count + 1, 3);
  pose.positions.row(count).setZero();
  auto positions = pose.positions.topRows(count);
  positions = primitive.positions;
  add_targets(primitive.target_positions, weights, positions);
  // The transform may take away a large offset, so it is applied in double.
  const Eigen::Matrix3d linear = transform.linear();
  const Eigen::Vector3d offset = transform.translation();
  for (Eigen::Index i = 0; i < count; ++i) {
    const Eigen::Vector3d moved = linear * positions.row(i).transpose().cast<double>() + offset;
    positions.row(i) = moved.cast<float>().transpose();
  }

  pose.colours = primitive.colours;
  if (pose.colours.rows() > 0) add_targets(primitive.target_colours, weights, pose.colours);
  pose.normals = primitive.normals;
  if (pose.normals.rows() == 0) return;
  add_targets(primitive.target_normals, weights, pose.normals);
  // The cofactor matrix is the inverse transpose up to a factor, and exists for flat transforms
  // too.
  const Eigen::Matrix3d unit = linear / std::max(linear.norm(), 1e-300);
  Eigen::Matrix3f cofactors;
  for (int k = 0; k < 3; ++k) {
    cofactors.col(k) = unit.col((k + 1) % 3).cross(unit.col((k + 2) % 3)).cast<float>();
  }
  for (Eigen::Index i = 0; i < count; ++i) {
    pose.normals.row(i) = (cofactors * pose.normals.row(i).transpose()).normalized().transpose();
  }
}

void pose_mesh(const AnimatedMesh& mesh, const Eigen::VectorXd& weights,
               const Eigen::Affine3d& transform, std::vector<PosedPrimitive>& poses) {
  poses.resize(mesh.primitives.size());
  for (std::size_t i = 0; i < poses.size(); ++i) {
    pose_primitive(mesh.primitives[i], weights, transform, poses[i]);
  }
}

}  // namespace morphbake
