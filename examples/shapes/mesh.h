// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>

namespace shapes {

using Rows3d = Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor>;
using Rows3i = Eigen::Matrix<int, Eigen::Dynamic, 3, Eigen::RowMajor>;

/// A coloured triangle mesh, counter-clockwise from outside, each vertex used.
struct Mesh {
  Rows3d positions;  // metres; only values that a float holds, so that checks see what is written
  Rows3d colors;     // linear RGB
  Rows3i triangles;
};

/// Rounds to what the file can hold.
void round_to_float(Rows3d& rows);

/// Moves the lowest vertex to y = 0.
void stand_on_floor(Mesh& mesh);

/// Unit normals, each face weighted by its angle at the vertex.
Rows3d vertex_normals(const Mesh& mesh);

struct AngleReport {
  double smallest;  // degrees
  double below_15;  // share of triangles with an angle below 15 degrees
};

AngleReport angles(const Mesh& mesh);

}  // namespace shapes
