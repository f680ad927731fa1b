#pragma once

#include <Eigen/Core>
#include <vector>

namespace morphbake {

/// #V by 3, scene units (metres in glTF).
using Positions = Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor>;

/// #V by 3, unit length.
using Normals = Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor>;

/// #F by 3 vertex indices, counter-clockwise seen from outside.
using Triangles = Eigen::Matrix<int, Eigen::Dynamic, 3, Eigen::RowMajor>;

/// A triangle mesh. Invariant: indices are in range; no triangle repeats an index.
struct Mesh {
  Positions positions;
  Triangles triangles;
};

/// The paper's K. Invariant: edge-manifold, oriented, every vertex used.
struct Connectivity {
  int vertex_count = 0;
  Triangles triangles;
};

/// A point on a mesh: barycentric coordinates in a triangle (sum 1, all >= 0).
struct SurfacePoint {
  int triangle = 0;
  Eigen::Vector3d barycentric = Eigen::Vector3d(1, 0, 0);
};

}  // namespace morphbake
