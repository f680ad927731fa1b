#include "morphbake/derive/transform.h"

#include <numbers>
#include <string>

#include "morphbake/derive/direction.h"
#include "morphbake/mesh/centre_of_mass.h"

namespace morphbake {

Eigen::Affine3d map_of(const Transform& transform, const Eigen::Vector3d& centre) {
  Eigen::Matrix3d linear = transform.scale * Eigen::Matrix3d::Identity();
  if (transform.scale_along) {
    const Eigen::Vector3d along = unit_direction(*transform.scale_along, "direction of scaling");
    linear = Eigen::Matrix3d::Identity() + (transform.scale - 1) * along * along.transpose();
  }
  if (transform.degrees != 0) {
    const Eigen::Vector3d axis = unit_direction(transform.axis, "axis of rotation");
    linear = Eigen::AngleAxisd(transform.degrees * std::numbers::pi / 180, axis) * linear;
  }
  Eigen::Affine3d map = Eigen::Affine3d::Identity();
  map.translation() = transform.translation;
  if (linear == Eigen::Matrix3d::Identity()) return map;
  const Eigen::Vector3d about = transform.about.value_or(centre);
  map.linear() = linear;
  map.translation() += about - linear * about;
  return map;
}

Positions mapped(const Positions& positions, const Eigen::Affine3d& map) {
  if (map.linear() == Eigen::Matrix3d::Identity()) {
    return positions.rowwise() + map.translation().transpose();
  }
  return (positions * map.linear().transpose()).rowwise() + map.translation().transpose();
}

Positions transformed(const Mesh& mesh, const Transform& transform) {
  return mapped(mesh.positions, map_of(transform, centre_of_mass(mesh.positions, mesh.triangles)));
}

}  // namespace morphbake
