#pragma once

#include <vector>

#include "morphbake/connectivity/morphable_mesh.h"
#include "morphbake/mesh/mesh.h"

namespace morphbake::test {

/// Four vertices, four triangles.
Mesh tetrahedron();

/// A UV sphere of radius 1 with shared poles: (rings - 1) * segments + 2 vertices, closed.
Mesh sphere(int rings, int segments);

/// A torus around Y, radii 1 and 0.4: rings * segments vertices, genus 1.
Mesh torus(int rings, int segments);

/// A flat grid in z = 0 with unit cells: columns * rows vertices, one boundary loop.
Mesh grid(int columns, int rows);

/// A closed square bar along y from 0 to 1, 0.2 wide: `across` cells a side, five times as many
/// along.
Mesh bar(int across);

/// A bar bent and twisted along y, radians a unit of length: no part of it changes its length on
/// the axis.
Positions bent_and_twisted(const Positions& bar, double bend, double twist);

/// Both meshes as two components of one.
Mesh joined(const Mesh& a, const Mesh& b);

/// `positions` moved by a smooth, seeded field of about `amount`.
Positions bent(const Positions& positions, double amount, unsigned seed);

/// A morphable mesh over given geometries, named "a", "b", "c", ...
MorphableMesh morphable(const Triangles& triangles, const std::vector<Positions>& geometries);

/// Seeded weights of `sources` by `vertices` whose columns sum to 1, different at every vertex.
Eigen::MatrixXd random_weights(int sources, int vertices, unsigned seed);

}  // namespace morphbake::test
