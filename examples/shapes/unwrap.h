// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "mesh.h"

namespace shapes {

using Rows2d = Eigen::Matrix<double, Eigen::Dynamic, 2, Eigen::RowMajor>;

/// A surface cut into charts that lie flat in the unit square. Seams are where charts meet.
struct Unwrapped {
  std::vector<int> charts;  // one a triangle
  Rows2d uv;                // 3 #triangles: corner 3 f + k; v runs down, as glTF has it
};

/// Cuts where labels change and lays every piece flat, as rigid as possible, upright and to scale.
///
/// Small islands first join the label around them.
/// @param labels  one a triangle
/// @see Liu et al. 2008, A local/global approach to mesh parameterization
/// @throws std::runtime_error when a piece cannot be laid flat
Unwrapped unwrap(const Mesh& mesh, const std::vector<int>& labels);

}  // namespace shapes
