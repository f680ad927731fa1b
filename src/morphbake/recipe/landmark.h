#pragma once

#include <Eigen/Core>
#include <string>
#include <variant>

namespace morphbake {

/// A vertex of a source's file, counted over its primitives.
struct VertexPlace {
  int vertex = 0;
};

/// A point in a triangle of a source's file, counted over its primitives.
struct TrianglePlace {
  int triangle = 0;
  Eigen::Vector3d barycentric;  ///< of the corners as the file has them; sum 1, all >= 0
};

/// Where a point of a source's surface is: scene coordinates, of which the closest point of the
/// surface is meant, or exactly there.
using Place = std::variant<Eigen::Vector3d, VertexPlace, TrianglePlace>;

/// A named point of a source's surface; corresponding points have one name on every source.
struct Landmark {
  std::string name;
  Place at;
};

}  // namespace morphbake
