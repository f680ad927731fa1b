#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "morphbake/mesh/adjacency.h"
#include "morphbake/mesh/mesh.h"

namespace morphbake {

/// One rotation a vertex.
using RotationField = std::vector<Eigen::Quaterniond>;

/// An edge between two vertices, a < b.
struct Edge {
  int a = 0, b = 0;
};

/// By their first vertex, then by their second.
std::vector<Edge> edges_of(const OneRings& rings);

/// How a shape is turned and stretched against another of the same connectivity, around each
/// vertex and along each edge.
struct Deformation {
  RotationField rotations;                 ///< R
  std::vector<Eigen::Matrix3d> stretches;  ///< S: the gradient of the deformation is R S
  /// log(R_a^T R_b), one an edge: how much b is turned beyond a, seen from a. Small everywhere, so
  /// that no branch of the logarithm is to be chosen.
  std::vector<Eigen::Vector3d> turns;
  /// One an edge: what the gradients leave of it, before the mean of its ends' rotations.
  std::vector<Eigen::Vector3d> remainders;
};

/// Of `to` against `from`, two shapes of one connectivity:
///
///   to_a - to_b = (M_a + M_b) / 2 (from_a - from_b) + (R_a + R_b) / 2 remainder,   M = R S
///
/// M is the least-squares gradient over a vertex's edges and its normal, without which flat
/// one-rings would leave it open; R S its polar decomposition, where S mirrors if M does.
/// @see   docs/method.md, "Shapes that are turned"
Deformation deformation_of(const OneRings& rings, const std::vector<Edge>& edges,
                           const Triangles& triangles, const Positions& from, const Positions& to);

}  // namespace morphbake
