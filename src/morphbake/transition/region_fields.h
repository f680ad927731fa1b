#pragma once

#include <Eigen/Core>
#include <memory>
#include <variant>
#include <vector>

#include "morphbake/diagnostics/problem.h"
#include "morphbake/mesh/mesh.h"
#include "morphbake/recipe/region.h"

namespace morphbake {

/// A spatial region with the coordinates in which it is evaluated.
struct SpatialField {
  SpatialRegion region;
  std::vector<std::shared_ptr<const Positions>> coordinates;  ///< one a source that counts: #V by 3
  Location where = {};                                        ///< in the recipe, for messages
};

/// When a flood reaches each vertex.
struct FloodField {
  Eigen::VectorXd order;  ///< #V: share of its way, each in [0, 1]
  double softness = 0;    ///< width of the front, likewise; 0: those with order < amount are inside
};

/// A region on K, ready to be evaluated.
struct RegionField {
  std::variant<Eigen::VectorXd, SpatialField, FloodField, CombinedRegion> form;  ///< d where fixed
  Falloff falloff = Falloff::Linear;
  bool moves = false;   ///< with time
  bool floods = false;  ///< with the amount of the edit
};

using RegionFields = std::vector<RegionField>;

/// Fields of regions that are the same at all times.
///
/// @param distances  d of each: #V, in [0, 1]
RegionFields fixed_fields(std::vector<Eigen::VectorXd> distances);

/// What d depends on besides the vertex.
struct RegionMoment {
  double time = 0;    ///< seconds
  double amount = 1;  ///< of the edit, in [0, 1]: how far floods have come
};

/// d of a region: 0 inside, 1 outside, between them across the soft ring.
///
/// @return  #V, each in [0, 1]
/// @throws BakeError "recipe.expression" where an expression gives no number
Eigen::VectorXd distance_at(const RegionFields& fields, int region, const RegionMoment& moment);

/// d of a region that neither moves nor floods.
const Eigen::VectorXd& fixed_distance(const RegionFields& fields, int region);

/// `d`, each in [0, 1], bent by the region's falloff.
Eigen::VectorXd bent_by(Falloff falloff, Eigen::VectorXd d);

}  // namespace morphbake
