#include "morphbake/gltf/morphed_rows.h"

#include <algorithm>

namespace morphbake {

Positions morphed_rows(const Float3s& base, const std::vector<Float3s>& targets,
                       const Eigen::VectorXd& weights) {
  Positions rows = base.cast<double>();
  const std::size_t count = std::min(targets.size(), static_cast<std::size_t>(weights.size()));
  for (std::size_t k = 0; k < count; ++k) {
    const double weight = weights(static_cast<Eigen::Index>(k));
    if (weight != 0 && targets[k].rows() > 0) rows += weight * targets[k].cast<double>();
  }
  return rows;
}

Positions morphed_positions(const AnimatedMesh& mesh, const Eigen::VectorXd& weights) {
  Eigen::Index count = 0;
  for (const AnimatedPrimitive& primitive : mesh.primitives) count += primitive.positions.rows();
  Positions positions(count, 3);
  Eigen::Index begin = 0;
  for (const AnimatedPrimitive& primitive : mesh.primitives) {
    const Eigen::Index rows = primitive.positions.rows();
    positions.middleRows(begin, rows) =
        morphed_rows(primitive.positions, primitive.target_positions, weights);
    begin += rows;
  }
  const Eigen::Matrix3d linear = mesh.to_scene.topLeftCorner<3, 3>();
  const Eigen::RowVector3d translation = mesh.to_scene.topRightCorner<3, 1>().transpose();
  return (positions * linear.transpose()).rowwise() + translation;
}

}  // namespace morphbake
