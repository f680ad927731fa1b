#pragma once

#include "morphbake/transition/region_fields.h"

namespace morphbake {

/// d of a spatial region, before its falloff: of each source's coordinates, averaged.
///
/// @return  #V, each in [0, 1]
/// @throws BakeError "recipe.expression" where an expression gives no number, or a plane or an
///         axis has no direction at that time
/// @see     Alexa 2003, section 5.2
Eigen::VectorXd spatial_distance(const SpatialField& field, double time);

/// Signed distance of each row to the border, negative inside; a ramp's and an expression's own
/// measure.
///
/// @param points  #P by 3
Eigen::VectorXd signed_distance(const SpatialRegion& region, const Positions& points, double time);

/// Finds what is wrong with an expression, without a point to evaluate it at.
///
/// @return  what the parser says, or ""
std::string expression_error(const std::string& text);

/// Whether the region is another at another time.
bool moves_with_time(const SpatialRegion& region);

/// Positions about the centre of mass of their surface (by area), in units of `unit`.
Positions centred_coordinates(const Mesh& mesh, double unit);

}  // namespace morphbake
