#include "morphbake/derive/direction.h"

#include <fmt/core.h>

#include "morphbake/diagnostics/problem.h"

namespace morphbake {

Eigen::Vector3d unit_direction(const Eigen::Vector3d& direction, const std::string& what) {
  // Twice: the squares of very large and small components are no numbers.
  const double largest = direction.cwiseAbs().maxCoeff();
  if (direction.allFinite() && largest > 0) return (direction / largest).normalized();
  throw BakeError(Problem{
      Severity::Error,
      "derive.no-direction",
      {},
      fmt::format("the {} is ({}, {}, {})", what, direction.x(), direction.y(), direction.z()),
      "give a vector that is not 0, such as [0, 1, 0]"});
}

}  // namespace morphbake
