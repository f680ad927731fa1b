#pragma once

#include <vector>

#include "morphbake/landmarks/shape_sketch.h"

namespace morphbake {

/// A shape's box along three directions: what positions of different shapes are compared in. Its
/// sides are four standard deviations of the area, so that one long tail does not make it long.
struct Frame {
  Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();  ///< columns, orthonormal; left-handed for a
                                                       ///< shape seen in a mirror
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();
  Eigen::Vector3d half_size = Eigen::Vector3d::Ones();  ///< along the axes, above 0

  /// Coordinates in the box, -1 to 1 for most of the surface.
  Eigen::Vector3d in_box(const Eigen::Vector3d& point) const {
    return (axes.transpose() * (point - centre)).cwiseQuotient(half_size);
  }
};

/// The box of a shape along these axes. Sides below a fifth of the longest count as such.
Frame frame_along(const Mesh& mesh, const Eigen::Matrix3d& axes);

/// Right-handed principal axes of a surface, the longest first.
Eigen::Matrix3d principal_axes(const Mesh& mesh);

/// How two shapes lie on each other: equal coordinates in their frames correspond.
struct Alignment {
  Frame a;
  Frame b;
  std::vector<int> partner;  ///< one a tip of a: tip of b, or -1
  double cost = 0;           ///< 0 fits perfectly; about 1 not at all
};

/// The tips that correspond when the frames do: alike in their place in the box, in their mean
/// distance to the surface, and in the distances between them.
Alignment align_in(const ShapeSketch& a, const ShapeSketch& b, const Frame& frame_a,
                   const Frame& frame_b);

/// The best alignment of two shapes by a motion, or by one and a mirror.
///
/// Tries all turns that take the axes of the scene, or the principal axes, into one another; of
/// equal fits the smaller turn wins, and what stands upright stays so.
enum class Handedness { Kept, Mirrored };
Alignment align_shapes(const ShapeSketch& a, const ShapeSketch& b, Handedness handedness);

/// Pairs up what tips are left, if they are not quite unlike: a straight tail and a curled one.
void match_rest(const ShapeSketch& a, const ShapeSketch& b, Alignment& alignment);

/// Mean distance between the shapes after the similarity that brings `alignment`'s tips together
/// and, from there, the surfaces; as a fraction of b's diagonal. Infinity with fewer than 3 pairs.
///
/// @see Umeyama 1991; Besl and McKay 1992
double surface_distance(const ShapeSketch& a, const ShapeSketch& b, const Alignment& alignment,
                        Handedness handedness);

}  // namespace morphbake
