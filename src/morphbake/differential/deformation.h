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

/// How a shape is turned against another of the same connectivity, around each vertex and along
/// each edge.
struct Deformation {
  RotationField rotations;  ///< R of the gradient R S
  /// log(R_a^T R_b), one an edge: how much b is turned beyond a, seen from a. Small everywhere, so
  /// that no branch of the logarithm is to be chosen.
  std::vector<Eigen::Vector3d> turns;
};

/// Of `to` against `from`, two shapes of one connectivity.
///
/// The gradient is the least-squares one over a vertex's edges and its normal, without which flat
/// one-rings would leave it open; R S its polar decomposition, where S mirrors if it does.
/// @see   docs/method.md, "Shapes that are turned"
Deformation deformation_of(const OneRings& rings, const std::vector<Edge>& edges,
                           const Triangles& triangles, const Positions& from, const Positions& to);

}  // namespace morphbake
