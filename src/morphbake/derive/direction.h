#pragma once

#include <Eigen/Core>
#include <string>

namespace morphbake {

/// `direction` with length 1.
///
/// @param what  "axis of rotation", for the message
/// @throws BakeError "derive.no-direction" for a vector without length, or one of no numbers
Eigen::Vector3d unit_direction(const Eigen::Vector3d& direction, const std::string& what);

}  // namespace morphbake
