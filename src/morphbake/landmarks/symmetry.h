#pragma once

#include <vector>

#include "morphbake/landmarks/alignment.h"

namespace morphbake {

/// The two sides of a shape.
struct Symmetry {
  bool found = false;
  bool is_exact = false;  ///< the surface is its own mirror image; else only its tips pair up
  Eigen::Vector3d sideways = Eigen::Vector3d::UnitX();  ///< unit normal of the mirror plane, to +X
  double offset = 0;                                    ///< the plane is sideways . x = offset
  std::vector<int> mirrored;  ///< one a tip: the tip across, itself on the plane, -1 when unknown

  /// Scene units, positive towards `sideways`.
  double side_of(const Eigen::Vector3d& point) const { return sideways.dot(point) - offset; }

  Eigen::Vector3d across(const Eigen::Vector3d& point) const {
    return point - 2 * side_of(point) * sideways;
  }
};

/// Finds the plane across which a shape is (nearly) its own mirror image.
///
/// Tries planes across the axes of the scene and the principal axes. A shape in a crooked pose has
/// no such plane; there tips pair up when their distances over the surface do.
Symmetry find_symmetry(const ShapeSketch& shape);

/// Drops tips that are small and close to a larger one, but for its mirror image: of the fingers of
/// a hand, one stays. Which finger is which cannot be told from distances.
void drop_branches(ShapeSketch& shape);

/// Makes partners agree with both shapes' sides: those of a pair are a pair, or nobody's.
void respect_symmetry(const Symmetry& a, const Symmetry& b, std::vector<int>& partner);

}  // namespace morphbake
