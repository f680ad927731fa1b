#pragma once

#include <Eigen/Geometry>
#include <optional>

#include "morphbake/mesh/mesh.h"

namespace morphbake {

/// What is done to a shape, in this order, about one point.
struct Transform {
  double scale = 1;
  std::optional<Eigen::Vector3d> scale_along;  ///< only in this direction; none: in all
  Eigen::Vector3d axis = Eigen::Vector3d::UnitY();
  double degrees = 0;  ///< about `axis`, counter-clockwise seen against it
  Eigen::Vector3d translation = Eigen::Vector3d::Zero();
  std::optional<Eigen::Vector3d> about;  ///< none: the centre of mass
};

/// @param centre  taken where `transform` has no `about`
/// @throws BakeError "derive.no-direction" when an axis that is needed has no length
Eigen::Affine3d map_of(const Transform& transform, const Eigen::Vector3d& centre);

/// Positions under a map; a translation is added without further rounding, and nothing changes
/// where the map changes nothing.
Positions mapped(const Positions& positions, const Eigen::Affine3d& map);

/// The shape transformed, about its centre of mass unless `about` says where.
///
/// @return #V by 3
/// @throws BakeError "derive.no-direction"
Positions transformed(const Mesh& mesh, const Transform& transform);

}  // namespace morphbake
